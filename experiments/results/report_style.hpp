// How a page looks: on a screen, bright or dark, wide or narrow, and on paper.
#pragma once

#include <string_view>

namespace beamid::experiments {

inline constexpr std::string_view report_style = R"css(
:root { --ink: #222; --ground: #fff; --soft: #f3f5f7; --stripe: rgba(0, 40, 80, .045); --line: #999; --note: #444;
  --link: #005a91; --warning: #8a5a00; --warning-ground: #fff6e0; --failure: #a32000; --failure-ground: #ffe9e3;
  --good: #00614a; --good-ground: #e3f5ee }
@media screen and (prefers-color-scheme: dark) {
  :root { color-scheme: dark; --ink: #ddd; --ground: #1a1a1a; --soft: #262a2e; --stripe: rgba(255, 255, 255, .05);
    --line: #777; --note: #aaa; --link: #6cb8ee; --warning: #f0b849; --warning-ground: #33290f; --failure: #ff8a66;
    --failure-ground: #3d1a10; --good: #5fd3ac; --good-ground: #10301f }
  .plot img { filter: invert(.9) hue-rotate(180deg) }
}
body { font: 16px/1.5 "DejaVu Sans", Verdana, sans-serif; color: var(--ink); background: var(--ground); max-width: 60rem;
  margin: 2rem auto; padding: 0 1rem; counter-reset: plot }
a { color: var(--link) }
h1, h2 { overflow-wrap: anywhere }
h1 { font-size: 1.5rem; line-height: 1.25; border-bottom: 2px solid #0072b2; padding-bottom: .3rem }
h2 { font-size: 1.15rem; margin-top: 2rem }
pre { background: var(--soft); padding: .6rem .8rem; white-space: pre-wrap; overflow-wrap: anywhere; font-size: .85rem }
p { white-space: pre-line; overflow-wrap: break-word }
nav { background: var(--soft); padding: .2rem 1rem; font-size: .9rem }
nav li { overflow-wrap: anywhere }
nav p { font-weight: bold; margin: .5rem 0 0 }
nav ol { margin: .3rem 0 .6rem; padding-left: 1.6rem }
.warning, .failure { border-left: 5px solid var(--warning); background: var(--warning-ground); padding: .6rem .9rem }
.failure { border-color: var(--failure); background: var(--failure-ground); font-weight: bold }
figure { margin: 1.5rem 0 }
.scroll { overflow-x: auto }
.verdict { border-left: 8px solid var(--good); background: var(--good-ground); padding: .5rem .9rem; font-size: 1.05rem }
.verdict b { color: var(--good) }
.verdict.doubtful { border-color: var(--warning); background: var(--warning-ground) }
.verdict.doubtful b { color: var(--warning) }
.verdict.bad { border-color: var(--failure); background: var(--failure-ground) }
.verdict.bad b { color: var(--failure) }
.verdict.good b::before { content: "\2713 " }
.verdict.doubtful b::before { content: "! " }
.verdict.bad b::before { content: "\2715 " }
.status { font-size: .85rem; color: var(--note) }
details { border-top: 1px solid var(--line); margin-top: 1rem }
summary { cursor: pointer; padding: .4rem 0 }
summary h2 { display: inline; margin: 0 }
button, select { font: inherit; font-size: .8rem; color: var(--ink); background: var(--soft); border: 1px solid var(--line);
  border-radius: 4px; padding: .1rem .5rem; cursor: pointer }
button[aria-pressed="true"] { border-color: var(--link) }
.legend button[aria-pressed="false"] { opacity: .75; text-decoration: line-through }
:focus-visible { outline: 2px solid var(--link); outline-offset: 1px }
.copy { float: right; margin: .4rem }
.motion:not(.alive) { display: none }
.motion figcaption { font-weight: normal; font-size: .9rem; text-align: center }
.live { display: none }
.bar { display: flex; flex-wrap: wrap; gap: .3rem .4rem; align-items: center; font-size: .8rem }
.bar input[type="range"] { width: 6rem; vertical-align: middle }
.help { color: var(--note); font-size: .75rem }
.grid { display: grid; grid-template-columns: repeat(var(--columns), minmax(0, 1fr)) }
.cell { position: relative; min-width: 0 }
.live canvas { width: 100%; display: block; touch-action: pan-y; cursor: crosshair }
.live canvas.swing { height: 26rem; touch-action: none; cursor: grab }
.reading { position: absolute; font-size: .78rem; background: var(--ground); border: 1px solid var(--line); padding: .15rem .45rem;
  pointer-events: none; max-width: 90%; overflow-wrap: anywhere; opacity: .95 }
.reading.still { position: static; border: 0; text-align: center }
.legend { display: flex; flex-wrap: wrap; gap: .3rem; justify-content: center; margin-top: .3rem }
.key { display: inline-block; width: 1.1rem; height: 3px; background: currentColor; vertical-align: middle; margin-right: .35rem }
.key.band { height: .7rem; opacity: .35 }
.key.points, .key.intervals, .key.stems { width: .6rem; height: .6rem; border-radius: 50% }
.key.open_points { width: .5rem; height: .5rem; border: 2px solid; border-radius: 50%; background: none }
@media screen {
  .alive > .live { display: block }
  .alive > .scroll { display: none }
}
@media screen and (min-width: 78rem) {
  nav { position: fixed; left: max(1rem, calc(50vw - 46rem)); top: 2rem; width: 12rem; max-height: calc(100vh - 4rem);
    overflow: auto; box-sizing: border-box }
  body { padding-left: 13rem; max-width: 62rem }
}
figcaption { font-weight: bold; margin-bottom: .3rem }
.plot figcaption { font-weight: normal; font-size: .9rem; margin-top: .3rem }
.plot figcaption::before { counter-increment: plot; content: "Figure " counter(plot) ". "; font-weight: bold }
img { max-width: 100%; min-width: 36rem; height: auto; display: block; margin: auto }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums }
th { text-align: left; vertical-align: bottom; border-bottom: 1px solid var(--ink) }
th, td { padding: .15rem .8rem .15rem 0 }
th:first-child, td:first-child { position: sticky; left: 0; background: var(--ground) }
tbody tr:nth-child(odd) td { background-image: linear-gradient(var(--stripe), var(--stripe)) }
.number { text-align: right; white-space: nowrap }
.note { font-size: .85rem; color: var(--note); margin-top: .3rem }
footer { margin-top: 3rem; border-top: 1px solid var(--line); font-size: .8rem; color: var(--note) }
@media screen and (max-width: 40rem) {
  .grid { grid-template-columns: minmax(0, 1fr) }
  .help { display: none }
  .alive.plot figcaption::after { content: none !important }
  body { font-size: 15px; margin: 1rem auto }
  .scroll { padding-bottom: .2rem; border-right: 2px dotted var(--line) }
  .plot figcaption::after { content: " (scrolls sideways)"; color: var(--note) }
  td:not(.number):not(:first-child) { min-width: 8rem }
  .table .scroll::after { content: "a wide table scrolls sideways"; display: block; position: sticky; left: 0;
    width: max-content; font-size: .75rem; color: var(--note) }
}
@media print {
  .bar, .copy, .motion, .live { display: none }
  details::details-content { content-visibility: visible; display: block; block-size: auto }
  body { max-width: none; margin: 0; font-size: 10pt }
  .scroll { overflow: visible }
  img { min-width: 0 }
  table { font-size: 7.5pt }
  th, td { padding: .1rem .5rem .1rem 0 }
  .number { white-space: normal }
  .table { break-inside: auto }
  .plot, tr, p { break-inside: avoid }
  h1, h2, .table > figcaption { break-after: avoid }
  .warning, .failure, pre, nav { print-color-adjust: exact; -webkit-print-color-adjust: exact }
}
)css";

}  // namespace beamid::experiments
