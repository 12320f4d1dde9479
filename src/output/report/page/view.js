// Walls and particles in space. Positions are 16-bit steps of the box; values those of their ranges.
function startView(space) {
  const view = document.getElementById("view");
  const slider = document.getElementById("frame");
  const moment = document.getElementById("moment");
  const choice = document.getElementById("colour");
  const size = document.getElementById("size");
  const play = document.getElementById("play");
  const walls = document.getElementById("walls");
  const probe = document.createElement("canvas");
  if (!(probe.getContext("webgl2") || probe.getContext("webgl"))) {
    view.textContent = "This browser has no WebGL, which the view needs; the snapshots can be opened in ParaView.";
    return;
  }
  slider.max = Math.max(0, space.frames.length - 1);
  const scaled = (steps, [low, high]) => Float32Array.from(steps, step => low + (high - low) * step / 65535);
  const axisOf = (steps, axis) => {
    const out = new Float32Array(steps.length / 3);
    for (let k = 0; k < out.length; k += 1) out[k] = space.low[axis] + (space.high[axis] - space.low[axis]) * steps[3 * k + axis] / 65535;
    return out;
  };
  const unpacked = new Map();
  const frameOf = index => {
    if (!unpacked.has(index)) {
      const frame = space.frames[index];
      const steps = shortsOf(frame.position);
      unpacked.set(index, { ...frame, x: axisOf(steps, 0), y: axisOf(steps, 1), z: axisOf(steps, 2), gas: bytesOf(frame.gas),
        speed: scaled(shortsOf(frame.speed), space.speed), temperature: scaled(shortsOf(frame.temperature), space.temperature),
        subdomain: shortsOf(frame.subdomain) });
    }
    return unpacked.get(index);
  };
  const every = (list, axis) => list.filter((_, k) => k % 3 === axis);
  const meshOf = wall => {
    const flat = floatsOf(wall.vertices), corners = wordsOf(wall.triangles);
    return { ...wall, x: every(flat, 0), y: every(flat, 1), z: every(flat, 2), i: every(corners, 0), j: every(corners, 1), k: every(corners, 2) };
  };
  const meshes = space.walls.map(meshOf);
  const fabrics = new Map();
  const fabricOf = index => {
    if (!fabrics.has(index)) fabrics.set(index, (space.frames[index]?.fabric ?? []).map(meshOf));
    return fabrics.get(index);
  };
  const names = [...meshes.map(mesh => mesh.name), ...new Set(space.frames.flatMap(frame => frame.fabric.map(one => one.name)))];
  names.forEach((name, index) => {
    const label = document.createElement("label");
    const box = document.createElement("input");
    box.type = "checkbox"; box.checked = true; box.dataset.wall = index;
    box.addEventListener("change", () => draw());
    label.append(box, ` ${name}`);
    walls.append(label);
  });
  const isShown = index => walls.querySelectorAll("input")[index].checked;
  const moved = (values, mesh, axis, frame) => mesh.shifts.length ? values.map(value => value + mesh.shifts[frame][axis]) : values;
  const surface = (mesh, frame, visible, look) => ({
    type: "mesh3d", name: mesh.name, x: moved(mesh.x, mesh, 0, frame), y: moved(mesh.y, mesh, 1, frame), z: moved(mesh.z, mesh, 2, frame),
    i: mesh.i, j: mesh.j, k: mesh.k, flatshading: true, hoverinfo: "name", visible, ...look,
  });
  const wallTraces = frame => [
    ...meshes.map((mesh, index) => surface(mesh, frame, isShown(index), { color: style("--soft"), opacity: 0.14 })),
    ...fabricOf(frame).map(mesh => surface(mesh, frame, isShown(names.indexOf(mesh.name, meshes.length)), { color: colour(4), opacity: 0.35 })),
  ];
  const marks = more => ({ size: Number(size.value), line: { width: 0 }, ...more });
  const pick = (values, kinds, kind) => values.filter((_, k) => kinds[k] === kind);
  const SOLID = ["circle", "square", "diamond", "cross", "x"];
  const kindTraces = (frame, kinds, names) => names.map((name, kind) => ({
    type: "scatter3d", mode: "markers", name, x: pick(frame.x, kinds, kind), y: pick(frame.y, kinds, kind), z: pick(frame.z, kinds, kind),
    hoverinfo: "name", showlegend: true, marker: marks({ color: colour(kind), symbol: SOLID[kind % SOLID.length] }),
  }));
  const valueTrace = (frame, values, range, title) => [{
    type: "scatter3d", mode: "markers", name: title, x: frame.x, y: frame.y, z: frame.z, text: [...values].map(said), hoverinfo: "text",
    showlegend: false, marker: marks({ color: values, cmin: range[0], cmax: range[1], colorscale: "Cividis", colorbar: { title: { text: title, side: "right" }, len: 0.85, tickfont: { color: style("--ink") } } }),
  }];
  const particleTraces = index => {
    if (space.frames.length === 0) return [];
    const frame = frameOf(index);
    if (choice.value === "gas") return kindTraces(frame, frame.gas, space.gases);
    if (choice.value === "subdomain") return kindTraces(frame, frame.subdomain, Array.from({ length: space.subdomains }, (_, rank) => `rank ${rank}`));
    if (choice.value === "temperature") return valueTrace(frame, frame.temperature, space.temperature, "temperature, K");
    return valueTrace(frame, frame.speed, space.speed, `speed, ${space.velocity}`);
  };
  const FIRST = { x: 1.4, y: -1.75, z: 0.95 };
  let eye = { ...FIRST };
  const axis = name => ({ title: { text: `${name}, ${space.length}` }, gridcolor: style("--line"), backgroundcolor: style("--back"), color: style("--ink") });
  const layout = () => ({
    margin: { l: 0, r: 0, t: 0, b: 0 }, uirevision: "keep", paper_bgcolor: style("--back"), font: { color: style("--ink") },
    legend: { x: 0, y: 1, bgcolor: style("--back"), itemsizing: "constant" },
    scene: { aspectmode: "data", uirevision: "keep", xaxis: axis("x"), yaxis: axis("y"), zaxis: axis("z"), camera: { eye } },
  });
  const draw = () => {
    const index = Number(slider.value);
    Plotly.react(view, [...wallTraces(index), ...particleTraces(index)], layout(), { responsive: true, displaylogo: false });
    const frame = space.frames[index];
    if (!frame) return;
    const shown = frameOf(index).x.length;
    moment.textContent = `${said(frame.time)} ${space.time}: ${frame.count.toLocaleString("en")} particles, ${shown.toLocaleString("en")} shown`;
    slider.setAttribute("aria-valuetext", moment.textContent);
  };
  const turn = (around, up, nearer) => {
    const now = view.layout.scene.camera ? view.layout.scene.camera.eye : eye;
    const radius = Math.hypot(now.x, now.y, now.z) * nearer;
    const azimuth = Math.atan2(now.y, now.x) + around;
    const height = Math.min(1.5, Math.max(-1.5, Math.asin(now.z * nearer / radius) + up));
    eye = { x: radius * Math.cos(height) * Math.cos(azimuth), y: radius * Math.cos(height) * Math.sin(azimuth), z: radius * Math.sin(height) };
    Plotly.relayout(view, { "scene.camera.eye": eye });
  };
  const KEYS = { ArrowLeft: [-0.15, 0, 1], ArrowRight: [0.15, 0, 1], ArrowUp: [0, 0.15, 1], ArrowDown: [0, -0.15, 1], "+": [0, 0, 0.85], "-": [0, 0, 1.18] };
  view.addEventListener("keydown", event => {
    if (event.key in KEYS) turn(...KEYS[event.key]);
    else if (event.key === "0") { eye = { ...FIRST }; Plotly.relayout(view, { "scene.camera.eye": eye }); }
    else return;
    event.preventDefault();
  });
  let timer = null;
  play.addEventListener("click", () => {
    if (timer !== null) { clearInterval(timer); timer = null; play.textContent = "Play"; return; }
    play.textContent = "Stop";
    timer = setInterval(() => { slider.value = (Number(slider.value) + 1) % Math.max(1, space.frames.length); draw(); }, 500);
  });
  slider.addEventListener("input", draw);
  choice.addEventListener("change", draw);
  size.addEventListener("input", draw);
  redraws.push(draw);
  // Drawn when it comes near the window, or is printed.
  let waits = true;
  const once = () => { if (waits) { waits = false; draw(); } };
  new IntersectionObserver(entries => { if (entries.some(entry => entry.isIntersecting)) once(); }, { rootMargin: "600px" }).observe(view);
  addEventListener("beforeprint", once);
}
if (held.view) startView(held.view);
