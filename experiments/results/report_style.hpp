// How a page looks: on a screen, bright or dark, wide or narrow, and on paper.
#pragma once

#include <string_view>

namespace beamid::experiments {

inline constexpr std::string_view report_style = R"css(
:root { --ink: #222; --ground: #fff; --soft: #f3f5f7; --stripe: rgba(0, 40, 80, .045); --line: #999; --note: #444;
  --link: #005a91; --warning: #8a5a00; --warning-ground: #fff6e0; --failure: #a32000; --failure-ground: #ffe9e3 }
@media screen and (prefers-color-scheme: dark) {
  :root { color-scheme: dark; --ink: #ddd; --ground: #1a1a1a; --soft: #262a2e; --stripe: rgba(255, 255, 255, .05);
    --line: #777; --note: #aaa; --link: #6cb8ee; --warning: #f0b849; --warning-ground: #33290f; --failure: #ff8a66;
    --failure-ground: #3d1a10 }
  .plot img { filter: invert(.9) hue-rotate(180deg) }
}
body { font: 16px/1.5 "DejaVu Sans", Verdana, sans-serif; color: var(--ink); background: var(--ground); max-width: 60rem;
  margin: 2rem auto; padding: 0 1rem; counter-reset: plot }
a { color: var(--link) }
h1 { font-size: 1.5rem; line-height: 1.25; border-bottom: 2px solid #0072b2; padding-bottom: .3rem }
h2 { font-size: 1.15rem; margin-top: 2rem }
pre { background: var(--soft); padding: .6rem .8rem; white-space: pre-wrap; overflow-wrap: anywhere; font-size: .85rem }
p { white-space: pre-line; overflow-wrap: break-word }
nav { background: var(--soft); padding: .2rem 1rem; font-size: .9rem }
nav p { font-weight: bold; margin: .5rem 0 0 }
nav ol { margin: .3rem 0 .6rem; padding-left: 1.6rem }
.warning, .failure { border-left: 5px solid var(--warning); background: var(--warning-ground); padding: .6rem .9rem }
.failure { border-color: var(--failure); background: var(--failure-ground); font-weight: bold }
figure { margin: 1.5rem 0 }
.scroll { overflow-x: auto }
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
  body { font-size: 15px; margin: 1rem auto }
  .scroll { padding-bottom: .2rem; border-right: 2px dotted var(--line) }
  .plot figcaption::after { content: " (scrolls sideways)"; color: var(--note) }
  td:not(.number):not(:first-child) { min-width: 8rem }
  .table .scroll::after { content: "a wide table scrolls sideways"; display: block; position: sticky; left: 0;
    width: max-content; font-size: .75rem; color: var(--note) }
}
@media print {
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
