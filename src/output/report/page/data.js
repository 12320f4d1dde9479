"use strict";
// What the page holds, unpacked as it is asked for; colours, dashes and marks; dark and light.
const held = JSON.parse(document.getElementById("data").textContent);
const bytesOf = text => Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
const floatsOf = text => new Float32Array(bytesOf(text).buffer);
const shortsOf = text => new Uint16Array(bytesOf(text).buffer);
const wordsOf = text => new Uint32Array(bytesOf(text).buffer);

// Okabe and Ito, and the same hues light enough for a dark page.
const LIGHT = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#b07800", "#3a9fd6", "#5a5a5a"];
const DARK = ["#56b4e9", "#ff9b52", "#2fc59a", "#e6a0c4", "#f0c64a", "#a5d8f7", "#c8c8c8"];
const SHAPES = ["circle", "square", "diamond", "cross", "x", "triangle-up", "star"];
const dark = () => {
  const chosen = document.documentElement.dataset.theme;
  return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
};
const colour = index => (dark() ? DARK : LIGHT)[index % LIGHT.length];
const style = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const redraws = [];
const redrawAll = () => redraws.forEach(redraw => redraw());
document.getElementById("theme").addEventListener("click", () => {
  document.documentElement.dataset.theme = dark() ? "light" : "dark";
  redrawAll();
});
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redrawAll);
// Five digits, as people read them.
const said = value => {
  if (!Number.isFinite(value)) return "no value";
  const size = Math.abs(value);
  return size !== 0 && (size < 1e-3 || size >= 1e7) ? value.toExponential(4) : String(Number(value.toPrecision(6)));
};
