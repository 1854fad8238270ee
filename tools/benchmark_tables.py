#!/usr/bin/env python3
"""Tables of a benchmark's report as Markdown, put between the markers of a page.

usage: spectile bench --json >report.json && tools/benchmark_tables.py report.json docs/benchmark.md

Between "<!-- NAME -->" and "<!-- end -->" of the page stands what was measured last; NAME is one of machine, limits,
operations, frontier, bounces, stress.
"""
import json
import re
import sys


def figure(value, digits=3):
    return f"{value:.{digits}g}" if abs(value) < 1000 else f"{value:.0f}"


def table(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|" + "|".join(["---"] + ["---:"] * (len(heads) - 1)) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def job_name(job):
    return job.split(";")[0]


def machine(r):
    m = r["machine"]
    disturbed = "" if not r["disturbed"] else "; other work took part of the processor in " + str(len(r["disturbed"])) + " of its parts"
    return (f"{m['processor']}, {m['cores']} cores, {m['system']}, {m['compiler']}, {m['date'][:10]}; "
            f"{r['seconds']:.0f} s{disturbed}.")


def limits(r):
    rows = []
    for l in r["limits"]:
        place = "memory" if l["level"] == "memory" else "cache"
        rows.append([f"{l['isa']}, {l['threads']} thread{'s' if l['threads'] > 1 else ''}, {place}"] +
                    [figure(l[k] * 1e-9) for k in ("load", "store", "stream", "copy")] +
                    [figure(l[k] * 1e-9) for k in ("multiply_add", "fused_multiply_add", "divide")])
    return table(["", "load, GB/s", "store", "round the caches", "copy", "products and sums, G/s", "fused", "quotients"],
                 rows)


def operations(r):
    names = []
    cells = {}
    for o in r["operations"]:
        if o["threads"] != 1:
            continue
        if o["name"] not in names:
            names.append(o["name"])
        cells[o["name"], o["isa"], o["level"]] = o
    rows = []
    for name in names:
        row = [name]
        notes = []
        for isa in ("avx2", "avx512"):
            for level in ("cache", "memory"):
                o = cells.get((name, isa, level))
                row.append("" if o is None else f"{100 * o['fraction']:.0f} % {o['limit']}")
                if o is not None and o["note"] and o["note"] not in notes:
                    notes.append(o["note"])
        o = cells.get((name, "avx512", "cache")) or cells.get((name, "avx2", "cache"))
        row += ["" if o is None else figure(o["items_per_second"] * 1e-6) + " M/s",
                "" if o is None else f"{figure(o['error'], 2)} of {figure(o['bound'])} {o['error_unit']}",
                "; ".join(notes)]
        rows.append(row)
    return table(["operation", "avx2, L2", "avx2, DRAM", "avx512, L2", "avx512, DRAM", "speed there", "error",
                  "what binds it instead"], rows)


def frontier(r):
    out = []
    groups = {}
    for w in r["ways"]:
        groups.setdefault((w["job"], w["light"]), []).append(w)
    for (job, light), ways in groups.items():
        shown = sorted((w for w in ways if w["frontier"] or w["family"] == "textbook"), key=lambda w: w["nanoseconds"])
        rows = [[("**" + w["name"] + "**") if w["frontier"] else w["name"], figure(w["nanoseconds"]),
                 f"{w['error']['mean']:.3f}", f"{w['error']['percentile95']:.3f}", f"{w['error']['maximum']:.2f}"]
                for w in shown]
        out.append(f"{job_name(job)}: {light}\n\n" + table(["", "ns", "mean", "95 %", "max"], rows))
    return "\n\n".join(out)


def bounces(r):
    out = []
    lights = list(dict.fromkeys(s["light"] for s in r["representations"]))
    for light in lights:
        rows = []
        for name in dict.fromkeys(s["name"] for s in r["representations"] if s["light"] == light):
            row = [name]
            for n in range(1, 6):
                s = next(s for s in r["representations"]
                         if s["light"] == light and s["name"] == name and s["bounces"] == n)
                row.append(f"{s['error']['mean']:.3f}, {s['error']['maximum']:.2f} ({figure(s['nanoseconds'])} ns)")
            rows.append(row)
        out.append(f"{light}\n\n" + table(["", "1 bounce", "2", "3", "4", "5"], rows))
    return "\n\n".join(out)


def stress(r):
    rows = [[s["operation"], s["inputs"], figure(s["bound"], 4), figure(s["worst"]), s["unit"], f"{s['cases']:,}".replace(",", " "),
             str(s["beyond"])] for s in r["stress"]]
    return table(["operation", "inputs", "bound", "worst found", "unit", "cases", "beyond"], rows)


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    with open(sys.argv[1], encoding="utf-8") as file:
        report = json.load(file)
    with open(sys.argv[2], encoding="utf-8") as file:
        page = file.read()
    for name, make in (("machine", machine), ("limits", limits), ("operations", operations), ("frontier", frontier),
                       ("bounces", bounces), ("stress", stress)):
        text = f"<!-- {name} -->\n{make(report)}\n<!-- end -->"
        page, found = re.subn(rf"<!-- {name} -->\n.*?<!-- end -->", lambda _, t=text: t, page, flags=re.S)
        if found != 1:
            print(f"{sys.argv[2]}: {found} places for {name}", file=sys.stderr)
            return 1
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(page)
    return 0


if __name__ == "__main__":
    sys.exit(main())
