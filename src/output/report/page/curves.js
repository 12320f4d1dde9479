// The line charts. A chart is drawn when it comes near the window, and all before the page is printed.
const series = held.series.map(one => ({ ...one, unpacked: new Map() }));
const columnOf = (index, column) => {
  const one = series[index];
  if (!one.unpacked.has(column)) one.unpacked.set(column, floatsOf(column === -1 ? one.time : one.columns[column].values));
  return one.unpacked.get(column);
};
const DASHED = { solid: "", dot: "2,4", dash: "8,5", dashdot: "8,4,2,4", longdash: "14,5" };
const MARKS = {
  circle: "M18 5a3 3 0 1 0 .01 0Z", square: "M15 5h6v6h-6Z", diamond: "M18 4l4 4-4 4-4-4Z", cross: "M17 4h2v3h3v2h-3v3h-2v-3h-3v-2h3Z",
  x: "M15 5l6 6M21 5l-6 6", "triangle-up": "M18 4l4 7h-8Z", star: "M18 3l1.5 3.5h3.5l-3 2 1.300 3.500-3.300-2-3.300 2 1.300-3.500-3-2h3.500Z",
};
const isPlain = curve => curve.dash === "dash";

function sampleOf(curve) {
  const tint = colour(curve.colour);
  const mark = isPlain(curve) ? "" : `<path d="${MARKS[SHAPES[curve.shape % SHAPES.length]]}" fill="${tint}" stroke="${tint}"/>`;
  return `<svg width="36" height="16" aria-hidden="true"><line x1="0" y1="8" x2="36" y2="8" stroke="${tint}" stroke-width="2" stroke-dasharray="${DASHED[curve.dash]}"/>${mark}</svg>`;
}

function drawChart(element) {
  const figure = held.figures[Number(element.dataset.figure)];
  const plot = element.querySelector(".plot");
  const readout = element.querySelector(".readout");
  const boxes = [...element.querySelectorAll("input[data-curve]")];
  const samples = [...element.querySelectorAll(".sample")];
  const isOn = index => boxes[index].checked;
  const xOf = curve => columnOf(curve.series, -1);
  const traces = () => figure.curves.map((curve, index) => ({
    type: "scatter", name: curve.label, x: xOf(curve), y: columnOf(curve.series, curve.column), visible: isOn(index),
    mode: isPlain(curve) ? "lines" : "lines+markers",
    line: { color: colour(curve.colour), width: 1.8, dash: curve.dash },
    marker: { symbol: SHAPES[curve.shape % SHAPES.length], size: 7, maxdisplayed: 12, color: colour(curve.colour) },
  }));
  const layout = () => ({
    margin: { l: 76, r: 16, t: 8, b: 44 }, showlegend: false, hovermode: "x unified", hoverdistance: -1, uirevision: "keep",
    paper_bgcolor: style("--back"), plot_bgcolor: style("--back"), font: { color: style("--ink") },
    hoverlabel: { bgcolor: style("--box"), font: { color: style("--ink") } },
    xaxis: { title: { text: `time, ${held.time}` }, gridcolor: style("--line"), zerolinecolor: style("--line") },
    yaxis: { title: { text: figure.title }, gridcolor: style("--line"), zerolinecolor: style("--line"), exponentformat: "SI" },
  });
  const config = { responsive: true, displaylogo: false, modeBarButtonsToRemove: ["lasso2d", "select2d"] };
  const draw = () => {
    samples.forEach((sample, index) => { sample.innerHTML = sampleOf(figure.curves[index]); });
    Plotly.react(plot, traces(), layout(), config);
  };
  draw();
  redraws.push(draw);
  const tell = points => {
    if (points.length === 0) return;
    const values = points.map(point => `${figure.curves[point.curve].label} ${said(point.y)}`);
    readout.textContent = `${said(points[0].x)} ${held.time}: ${values.join("; ")}`;
  };
  plot.on("plotly_hover", event => tell(event.points.map(point => ({ curve: point.curveNumber, x: point.x, y: point.y }))));
  boxes.forEach((box, index) => box.addEventListener("change", () => Plotly.restyle(plot, { visible: box.checked }, [index])));
  readByKeys(plot, figure, isOn, tell);
}

// The keys that a pointer would else be needed for.
function readByKeys(plot, figure, isOn, tell) {
  let row = null;
  const shown = () => figure.curves.map((curve, index) => index).filter(isOn);
  const read = () => {
    const first = figure.curves[shown()[0]];
    const time = columnOf(first.series, -1)[row];
    const points = shown().map(index => {
      const own = columnOf(figure.curves[index].series, -1);
      let near = Math.min(row, own.length - 1);
      while (near > 0 && own[near] > time) near -= 1;
      while (near + 1 < own.length && Math.abs(own[near + 1] - time) <= Math.abs(own[near] - time)) near += 1;
      return { curve: index, number: near, x: own[near], y: columnOf(figure.curves[index].series, figure.curves[index].column)[near] };
    });
    Plotly.Fx.hover(plot, points.map(point => ({ curveNumber: point.curve, pointNumber: point.number })));
    tell(points);
  };
  const zoom = factor => {
    const [low, high] = plot.layout.xaxis.range;
    const first = shown()[0];
    const middle = row === null ? (low + high) / 2 : columnOf(figure.curves[first].series, -1)[row];
    Plotly.relayout(plot, { "xaxis.range": [middle + (low - middle) * factor, middle + (high - middle) * factor] });
  };
  plot.addEventListener("keydown", event => {
    if (shown().length === 0) return;
    const last = columnOf(figure.curves[shown()[0]].series, -1).length - 1;
    if (last < 0) return;
    const page = Math.max(1, Math.round(last / 20));
    const moves = { ArrowLeft: -1, ArrowRight: 1, PageUp: -page, PageDown: page, Home: -Infinity, End: Infinity };
    if (event.key in moves) {
      row = Math.min(last, Math.max(0, row === null ? 0 : row + moves[event.key]));
      read();
    } else if (event.key === "+" || event.key === "-") {
      zoom(event.key === "+" ? 0.5 : 2);
    } else if (event.key === "0") {
      Plotly.relayout(plot, { "xaxis.autorange": true, "yaxis.autorange": true });
    } else if (event.key === "Escape") {
      row = null;
      Plotly.Fx.unhover(plot);
    } else {
      return;
    }
    event.preventDefault();
  });
}

const waiting = new Set(document.querySelectorAll("figure.chart"));
const drawIfWaiting = element => { if (waiting.delete(element)) drawChart(element); };
const near = new IntersectionObserver(entries => entries.filter(entry => entry.isIntersecting).forEach(entry => drawIfWaiting(entry.target)), { rootMargin: "600px" });
waiting.forEach(element => near.observe(element));
addEventListener("beforeprint", () => [...waiting].forEach(drawIfWaiting));
