// The style sheet of a report's page.
#include "bench/report/sections.hpp"

namespace spectile::report {

// Narrow screens first; paper last. Nothing may be wider than the page but what is in a box that scrolls.
const char* const kStyleSheet = R"css(
:root {
  color-scheme: light dark;
  --ink: #1b1f24; --paper: #ffffff; --soft: #505965; --line: #d5dae0; --band: #f3f5f8; --link: #005a9c;
  --red: #b00020; --red-band: #fdecee; --green: #00664a; --best-band: #e8f5f0; --warn-band: #fff4d6;
  --warn-line: #b58900; --bar: #0072b2;
}
@media screen and (prefers-color-scheme: dark) {
  :root {
    --ink: #e6e9ed; --paper: #15181c; --soft: #a9b2bd; --line: #3a424c; --band: #1e2329; --link: #7cc4ff;
    --red: #ff8a93; --red-band: #3a1a1e; --green: #5fd3a8; --best-band: #14302a; --warn-band: #3a3016;
    --warn-line: #d9a800; --bar: #56b4e9;
  }
  svg .ink { fill: var(--ink); }
  svg .grid { stroke: var(--line); }
  svg .halo { stroke: var(--paper); }
  svg .cross { stroke: var(--ink); }
  svg .frontier, svg .leader { stroke: var(--soft); }
  svg .mark, .key g { stroke: #e6e9ed; }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; text-size-adjust: 100%; }
body {
  margin: 0 auto; padding: 0 0.75rem 4rem; max-width: 78rem; background: var(--paper); color: var(--ink);
  font: 1rem/1.5 system-ui, "DejaVu Sans", Arial, sans-serif;
}
h1, h2, h3, p, li, dd, summary, figcaption { overflow-wrap: anywhere; }
h1 { font-size: 1.5rem; line-height: 1.25; margin: 1.5rem 0 0.75rem; }
h2 { font-size: 1.3rem; line-height: 1.25; margin: 2.5rem 0 0.5rem; padding-top: 0.75rem; border-top: 2px solid var(--line); }
h3 { font-size: 1.1rem; margin: 1.75rem 0 0.5rem; }
p, ul { max-width: 46rem; }
a { color: var(--link); }
nav ul { display: flex; flex-wrap: wrap; gap: 0.35rem 1.25rem; list-style: none; margin: 0; padding: 0.6rem 0; max-width: none; }
nav { border-block: 1px solid var(--line); }
nav a { display: inline-block; padding: 0.15rem 0; overflow-wrap: anywhere; }
.facts { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 20rem), 1fr)); gap: 0.5rem 1.5rem; margin: 0; }
.facts dt { color: var(--soft); font-size: 0.875rem; }
.facts dd { margin: 0; }
.warning { border: 2px solid var(--warn-line); background: var(--warn-band); border-radius: 6px; padding: 0.25rem 1rem; margin: 1.5rem 0; }
.advice li { margin: 0.35rem 0; }
pre { background: var(--band); padding: 0.75rem; overflow-x: auto; border-radius: 6px; }
code { font-size: 0.95em; }
.bad { color: var(--red); }
.good { color: var(--green); }

figure { margin: 0.75rem 0 1rem; max-width: 66rem; }
figcaption { color: var(--soft); font-size: 0.9rem; max-width: 46rem; margin-bottom: 0.25rem; }
svg.chart { display: block; width: 100%; height: auto; }
svg.wide { display: none; }
svg.narrow { max-width: 34rem; margin: 0 auto; }
.key { width: 1em; height: 1em; vertical-align: -0.12em; }

details { margin: 0.75rem 0; }
summary { cursor: pointer; padding: 0.25rem 0; color: var(--link); }
.scroll { overflow-x: auto; max-width: 100%; margin: 0.5rem 0 1.25rem; border: 1px solid var(--line); border-radius: 6px; }
.scroll:focus-visible { outline: 2px solid var(--link); }
table { border-collapse: separate; border-spacing: 0; width: 100%; font-size: 0.9rem; line-height: 1.35; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--soft); padding: 0.5rem 0.6rem; }
/* As wide as the box, not as the table, and there wherever that has scrolled to. */
caption span { display: inline-block; position: sticky; left: 0.6rem; max-width: min(44rem, calc(100vw - 3rem)); }
small { display: block; color: var(--soft); font-size: 0.93em; font-weight: 400; }
td small { min-width: 14rem; }
tr.beyond small { color: inherit; }
th, td { padding: 0.32rem 0.45rem; text-align: right; vertical-align: baseline; white-space: nowrap; border-top: 1px solid var(--line); font-weight: 400; }
th.words, td.words { text-align: left; }
thead th { font-weight: 600; background: var(--band); }
tbody th { text-align: left; }
td.words { white-space: normal; min-width: 5rem; max-width: 22rem; overflow-wrap: anywhere; }
/* The row's name stays while the numbers scroll. */
tr > th:first-child { position: sticky; left: 0; background: var(--paper); white-space: normal; min-width: 8.5rem; max-width: 11rem; overflow-wrap: anywhere; border-right: 1px solid var(--line); }
thead tr > th:first-child { background: var(--band); }
tr.group > th:first-child { position: static; max-width: none; white-space: nowrap; background: var(--band); font-weight: 600; border-right: 0; }
tr.group span { position: sticky; left: 0.6rem; }
tr.best > *, tr.best > th:first-child { font-weight: 700; background: var(--best-band); }
tr.beyond > *, tr.beyond > th:first-child { color: var(--red); background: var(--red-band); }
.no { color: var(--soft); display: inline-block; min-width: 1.4em; text-align: right; }
.badge { display: inline-block; font-size: 0.8rem; font-weight: 600; line-height: 1.3; padding: 0 0.4em; border: 1px solid currentColor; border-radius: 4px; white-space: nowrap; }
.badge.best { color: var(--green); }
.badge.bad { color: var(--red); }
.bar { display: inline-block; width: 2rem; height: 0.7em; background: var(--line); border-radius: 2px; overflow: hidden; }
.fraction { white-space: nowrap; }
.share { display: inline-block; min-width: 3.4em; text-align: right; }
.bar i { display: block; height: 100%; background: var(--bar); }

@media (min-width: 48rem) {
  body { padding: 0 1.5rem 5rem; }
  h1 { font-size: 2rem; }
  h2 { font-size: 1.5rem; }
  svg.wide { display: block; }
  svg.narrow { display: none; }
  tr > th:first-child { min-width: 12rem; max-width: 22rem; }
  .bar { width: 5rem; }
  th, td { padding: 0.32rem 0.6rem; }
}

@page { margin: 14mm; }
@media print {
  :root { color-scheme: light; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  body { max-width: none; padding: 0; font-size: 10pt; }
  nav { display: none; }
  a { color: inherit; text-decoration: none; }
  h2, h3, summary, figcaption, caption { break-after: avoid; }
  figure, tr, .warning, pre { break-inside: avoid; }
  svg.wide { display: block; }
  svg.narrow { display: none; }
  .scroll { overflow: visible; border: 0; }
  table { font-size: 7.5pt; }
  th, td { white-space: normal; padding: 1.2pt 3pt; }
  th.words, td.words { overflow-wrap: normal; }
  td small { min-width: 0; }
  .badge { font-size: 1em; padding: 0 0.25em; }
  td.words, tr > th:first-child { position: static; min-width: 0; max-width: none; overflow-wrap: normal; }
  thead { display: table-header-group; }
  .bar { width: 2rem; }
  .bar, .share { vertical-align: middle; }
  caption span { position: static; max-width: none; }
  /* On paper nothing can be opened. */
  details::details-content { content-visibility: visible; display: block; height: auto; }
}
)css";

}  // namespace spectile::report
