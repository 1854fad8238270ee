"""Markdown tables of a benchmark's report, put between the markers of pages; see figures.py."""
import json
import re
import sys

from figure_tools import table


def figure(value, digits=3):
    return f"{value:.{digits}g}" if abs(value) < 1000 else f"{value:.0f}"


def report_machine(r):
    m = r["machine"]
    disturbed = f"; other work took part of the processor in {len(r['disturbed'])} of its parts" if r["disturbed"] else ""
    return (f"{m['processor']}, {m['cores']} cores, {m['system']}, {m['compiler']}, {m['date'][:10]}; "
            f"{r['seconds']:.0f} s{disturbed}.")


def report_limits(r):
    keys = ("load", "store", "stream", "copy", "multiply_add", "fused_multiply_add", "divide")
    return table(["", "load, GB/s", "store", "non-temporal store", "copy", "multiply-add, G/s", "fused", "divide"],
                 [[f"{l['isa']}, {l['threads']} thread{'s' if l['threads'] > 1 else ''}, {l['level']}"]
                  + [figure(l[key] * 1e-9) for key in keys] for l in r["limits"]])


def report_operations(r):
    cells = {(o["name"], o["isa"], o["level"]): o for o in r["operations"] if o["threads"] == 1}
    rows = []
    for name in dict.fromkeys(name for name, _, _ in cells):
        places = [cells.get((name, isa, level)) for isa in ("avx2", "avx512") for level in ("cache", "memory")]
        there = cells.get((name, "avx512", "cache")) or cells.get((name, "avx2", "cache"))
        rows.append([name] + ["" if o is None else f"{100 * o['fraction']:.0f} % {o['limit']}" for o in places]
                    + ["" if there is None else figure(there["items_per_second"] * 1e-6) + " M/s",
                       "" if there is None else
                       f"{figure(there['error'], 2)} of {figure(there['bound'])} {there['error_unit']}",
                       "; ".join(dict.fromkeys(o["note"] for o in places if o is not None and o["note"]))])
    return table(["operation", "avx2, L2", "avx2, DRAM", "avx512, L2", "avx512, DRAM", "speed there", "error",
                  "bottleneck instead"], rows)


def report_baseline(r):
    return r["machine"]["processor"] + ":\n\n" + table(
        ["operation", "ns", "AoS baseline, ns", "ratio", "loops fused, ns", "ratio", "error", "baseline's error"],
        [[b["name"], figure(b["nanoseconds"]), figure(b["baseline_nanoseconds"]), f"**{figure(b['ratio'])}**",
          figure(b["fused_nanoseconds"]) if b["fused_nanoseconds"] else "",
          figure(b["fused_ratio"]) if b["fused_nanoseconds"] else "",
          f"{b['error']:.1e}", f"{b['baseline_error']:.1e}"] for b in r["baseline"]])


def report_frontier(r):
    out = []
    for job, light in dict.fromkeys((w["job"], w["light"]) for w in r["ways"]):
        shown = [w for w in r["ways"] if (w["job"], w["light"]) == (job, light)
                 and (w["frontier"] or w["family"] == "AoS baseline")]
        rows = [[f"**{w['name']}**" if w["frontier"] else w["name"], figure(w["nanoseconds"])]
                + [f"{w['error'][key]:.3f}" for key in ("mean", "percentile95", "maximum")]
                for w in sorted(shown, key=lambda w: w["nanoseconds"])]
        out.append(f"{job.split(';')[0]}: {light}\n\n" + table(["", "ns", "mean", "95 %", "max"], rows))
    return "\n\n".join(out)


def report_bounces(r):
    out = []
    for light in dict.fromkeys(s["light"] for s in r["representations"]):
        of = [s for s in r["representations"] if s["light"] == light]
        rows = [[name] + [f"{s['error']['mean']:.3f}, {s['error']['maximum']:.2f} ({figure(s['nanoseconds'])} ns)"
                          for s in sorted((s for s in of if s["name"] == name), key=lambda s: s["bounces"])]
                for name in dict.fromkeys(s["name"] for s in of)]
        out.append(f"{light}\n\n" + table(["", "1 bounce", "2", "3", "4", "5"], rows))
    return "\n\n".join(out)


def report_stress(r):
    return table(["operation", "inputs", "bound", "worst found", "unit", "cases", "beyond"],
                 [[s["operation"], s["inputs"], figure(s["bound"], 4), figure(s["worst"]), s["unit"],
                   f"{s['cases']:,}".replace(",", " "), s["beyond"]] for s in r["stress"]])


def report(args):
    with open(args.report, encoding="utf-8") as file:
        r = json.load(file)
    pages = {}
    for path in args.page:
        with open(path, encoding="utf-8") as file:
            pages[path] = file.read()
    for name in ("machine", "limits", "operations", "baseline", "frontier", "bounces", "stress"):
        text, places = f"<!-- {name} -->\n{globals()['report_' + name](r)}\n<!-- end -->", 0
        for path, page in pages.items():
            pages[path], found = re.subn(rf"<!-- {name} -->\n.*?<!-- end -->", lambda _, t=text: t, page, flags=re.S)
            places += found
        if places != 1:
            sys.exit(f"figures: {', '.join(pages)}: {places} places for {name}")
    for path, page in pages.items():
        with open(path, "w", encoding="utf-8") as file:
            file.write(page)
