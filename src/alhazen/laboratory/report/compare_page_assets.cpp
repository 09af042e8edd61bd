#include "alhazen/laboratory/report/compare_page_assets.h"

namespace alhazen {

// Two colour sets, chosen by the system setting or by the button. All text has a contrast of at
// least 4.5 to its background in both.
const char* const kComparePageStyle = R"css(
:root{--bg:#fbfaf7;--card:#fff;--ink:#1d2330;--soft:#5a6374;--line:#dcdad2;--accent:#0b63a8;
--good:#17703a;--bad:#b3261e;--bar:#4a7fb5;--tuned:#c77d1c;--given:#7a63b8;
--eye:#0b63a8;--shadow:#4b5160;--reflection:#a0430a;--refraction:#7a2a86}
@media (prefers-color-scheme:dark){:root:not([data-theme=light]){--bg:#12151c;--card:#1a1f29;--ink:#e8eaf0;
--soft:#a3adbf;--line:#323a49;--accent:#7cc0ff;--good:#6fd08f;--bad:#ff8a80;--bar:#5b93cc;--tuned:#d9983f;
--given:#a48be0;--eye:#7cc0ff;--shadow:#b4bccb;--reflection:#ff9f63;--refraction:#e39bef}}
:root[data-theme=dark]{--bg:#12151c;--card:#1a1f29;--ink:#e8eaf0;
--soft:#a3adbf;--line:#323a49;--accent:#7cc0ff;--good:#6fd08f;--bad:#ff8a80;--bar:#5b93cc;--tuned:#d9983f;
--given:#a48be0;--eye:#7cc0ff;--shadow:#b4bccb;--reflection:#ff9f63;--refraction:#e39bef}
*{box-sizing:border-box}
body{margin:0;background:var(--bg);color:var(--ink);font:16px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,sans-serif}
header,main,footer{max-width:72rem;margin:0 auto;padding:0 1rem}
header{padding-top:1.5rem;display:flex;gap:1rem;align-items:flex-start;justify-content:space-between}
h1{font-size:1.7rem;line-height:1.2;margin:0}
h2{font-size:1.35rem;margin:2.2rem 0 .3rem;overflow-wrap:anywhere}
h3{font-size:1.05rem;margin:0 0 .2rem}
p{margin:.3rem 0}
.soft,.facts{color:var(--soft)}
a{color:var(--accent)}
button{font:inherit;color:inherit;background:var(--card);border:1px solid var(--line);border-radius:.5rem;
padding:.3rem .7rem;cursor:pointer}
button:focus-visible,input:focus-visible,a:focus-visible,.scroll:focus-visible{outline:3px solid var(--accent);outline-offset:2px}
.card{background:var(--card);border:1px solid var(--line);border-radius:.8rem;padding:1rem;margin:1rem 0}
.badge{display:inline-block;border-radius:1rem;padding:.1rem .8rem;border:1px solid;font-weight:600}
.badge.good{color:var(--good)}.badge.bad{color:var(--bad)}
.viewer{display:grid;grid-template-columns:minmax(0,1fr) minmax(0,1.1fr);gap:1rem}
.stage{position:relative;line-height:0;border-radius:.4rem;overflow:hidden;background:#000}
.stage img{width:100%;height:auto;image-rendering:pixelated}
.stage img+img{position:absolute;inset:0;clip-path:inset(0 0 0 var(--cut,50%))}
.stage i{position:absolute;top:0;bottom:0;left:var(--cut,50%);width:2px;margin-left:-1px;background:#fff;
box-shadow:0 0 4px #000}
.viewer input[type=range]{width:100%;margin:.6rem 0 0;accent-color:var(--accent)}
.ends{display:flex;justify-content:space-between;gap:1rem;font-size:.85rem;color:var(--soft)}
.thumbs{display:grid;grid-template-columns:repeat(auto-fill,minmax(6.6rem,1fr));gap:.5rem;align-content:start}
.thumbs button{padding:.25rem;display:block;text-align:left;font-size:.75rem;line-height:1.25;overflow-wrap:anywhere}
.thumbs button[aria-pressed=true]{border-color:var(--accent);box-shadow:0 0 0 2px var(--accent)}
.thumbs small{display:block}
.thumbs img{width:100%;height:auto;display:block;border-radius:.25rem;margin-bottom:.2rem;image-rendering:pixelated}
.scale{height:.8rem;border-radius:.3rem;margin-top:.8rem}
.charts{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,26rem),1fr));gap:1rem}
.charts .card{margin:0}
.chart{margin:.6rem 0 0;display:grid;grid-template-columns:minmax(5rem,34%) minmax(0,1fr);gap:.18rem .6rem;font-size:.82rem;align-items:center}
.chart dt{text-align:right;overflow-wrap:anywhere;line-height:1.15}
.chart dt small{color:var(--soft);display:block}
.chart dd{margin:0;display:flex;align-items:center;gap:.4rem;min-width:0}
.track{flex:1;position:relative;height:1.05rem;min-width:0;
background:var(--grid)}
.lanes .track{height:1.7rem}
.axis .track{background:none;height:1.2rem}
.axis .track span{position:absolute;transform:translateX(-50%);color:var(--soft);white-space:nowrap}
.axis .track span:first-child{transform:none}
.fill{position:absolute;inset:.1rem auto .1rem 0;background:var(--bar);border-radius:0 .2rem .2rem 0;min-width:2px}
.tuned .fill{background:var(--tuned)}.given .fill{background:var(--given)}
.value{width:5.2rem;flex:none;font-variant-numeric:tabular-nums;color:var(--soft)}
.dot{position:absolute;width:.55rem;height:.55rem;margin:-.27rem 0 0 -.27rem}
.dot.eye{background:var(--eye);border-radius:50%;top:14%}
.dot.shadow{background:var(--shadow);top:38%}
.dot.reflection{background:var(--reflection);clip-path:polygon(50% 0,100% 50%,50% 100%,0 50%);top:62%}
.dot.refraction{background:var(--refraction);clip-path:polygon(50% 0,100% 100%,0 100%);top:86%}
.key{display:flex;flex-wrap:wrap;gap:.2rem 1rem;font-size:.82rem;color:var(--soft);margin:.3rem 0}
.key .dot{position:static;display:inline-block;margin:0 .3rem 0 0;vertical-align:middle}
.key .swatch{display:inline-block;width:1rem;height:.7rem;margin-right:.3rem;background:var(--bar);border-radius:.15rem}
.key .swatch.tuned{background:var(--tuned)}.key .swatch.given{background:var(--given)}
.scroll{overflow-x:auto}
table{border-collapse:collapse;font-size:.84rem;font-variant-numeric:tabular-nums;width:100%}
caption{text-align:left;color:var(--soft);padding-bottom:.4rem}
th,td{padding:.3rem .5rem;border-bottom:1px solid var(--line);text-align:right;white-space:nowrap}
th:first-child,td:first-child{text-align:left;position:sticky;left:0;background:var(--card);white-space:normal;min-width:8rem}
tbody th{font-weight:600;overflow-wrap:anywhere}
tbody th small{display:block;font-weight:400;color:var(--soft)}
thead button{border:0;background:none;padding:0;font-weight:600}
thead button::after{content:"\2195";color:var(--soft);margin-left:.2rem;font-weight:400}
th[aria-sort=ascending] button::after{content:"\2191";color:var(--accent)}
th[aria-sort=descending] button::after{content:"\2193";color:var(--accent)}
.no{color:var(--bad);font-weight:600}.yes{color:var(--good)}
footer{padding-bottom:3rem;color:var(--soft);font-size:.88rem}
@media (max-width:44rem){.viewer{grid-template-columns:1fr}h1{font-size:1.35rem}.card{padding:.7rem}
.value{width:4.4rem}.thumbs{grid-template-columns:repeat(3,1fr)}}
@media print{.viewer input,.ends,#theme{display:none}}
)css";

// Theme button, viewer of each scene, sorting. Uses no library.
const char* const kComparePageScript = R"js(
"use strict";
(() => {
  const root = document.documentElement;
  const theme = document.getElementById("theme");
  theme.hidden = false;
  theme.addEventListener("click", () => {
    const dark = root.dataset.theme ? root.dataset.theme === "dark"
                                    : matchMedia("(prefers-color-scheme: dark)").matches;
    root.dataset.theme = dark ? "light" : "dark";
  });
  for (const viewer of document.querySelectorAll(".viewer")) {
    const stage = viewer.querySelector(".stage");
    const range = viewer.querySelector("input");
    const over = stage.querySelectorAll("img")[1];
    const shown = viewer.querySelector(".shown");
    const cut = () => stage.style.setProperty("--cut", range.value + "%");
    range.addEventListener("input", cut);
    cut();
    const buttons = [...viewer.querySelectorAll(".thumbs button")];
    for (const button of buttons) {
      button.addEventListener("click", () => {
        const image = button.querySelector("img");
        over.src = image.src;
        over.alt = image.alt;
        shown.textContent = button.dataset.name;
        for (const other of buttons) other.setAttribute("aria-pressed", String(other === button));
      });
    }
    const drag = event => {
      const box = stage.getBoundingClientRect();
      range.value = String(Math.round(100 * (event.clientX - box.left) / box.width));
      cut();
    };
    stage.addEventListener("pointerdown", event => { stage.setPointerCapture(event.pointerId); drag(event); });
    stage.addEventListener("pointermove", event => { if (event.buttons) drag(event); });
  }
  for (const table of document.querySelectorAll("table")) {
    const heads = [...table.tHead.rows[0].cells];
    heads.forEach((head, column) => head.querySelector("button").addEventListener("click", () => {
      const up = head.getAttribute("aria-sort") !== "ascending";
      for (const other of heads) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", up ? "ascending" : "descending");
      const value = row => {
        const text = row.cells[column].dataset.value ?? row.cells[column].textContent.trim();
        const number = Number(text);
        return text !== "" && Number.isFinite(number) ? number : text;
      };
      const rows = [...table.tBodies[0].rows];
      rows.sort((a, b) => {
        const x = value(a), y = value(b);
        const order = typeof x === "number" && typeof y === "number" ? x - y
                    : String(x).localeCompare(String(y));
        return up ? order : -order;
      });
      table.tBodies[0].append(...rows);
    }));
  }
})();
)js";

}  // namespace alhazen
