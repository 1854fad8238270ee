#!/usr/bin/env python3
"""Figures of README.md and docs/*.md that `spectile bench` does not print: Markdown tables and SVG plots.

usage: bench/figures.py COMMAND [--tool build/spectile] ...    (figures.py COMMAND --help lists its options)

  report REPORT.json PAGE.md... tables of a report (`spectile bench --json`) between the pages' markers
  convergence                  error of a film against samples a pixel
  planning                     colour error against number of bands, even and planned
  planned                      upsampling to planned bands against 60 even ones
  skipping                     cost of black, masked and repeated parts of a texture
  end-to-end                   `spectile upsample` against OpenEXR alone writing the same planes
  compression IMAGE.exr        time and size of every compression
  methods                      round trips, gamuts and errors under other lights of the methods

Needs nothing but Python 3 and the tool; planned, skipping and end-to-end also build/bench/spectile_bench_exr (--exr).
Runs of things that are compared alternate; figures are medians unless their heading says otherwise.
"""
import argparse
import json
import math
import os
import statistics
import sys
import tempfile

from figure_methods import methods
from figure_report import report
from figure_tools import color_errors, line_plot, run, table, tool, write_image


def convergence(args):
    """Errors fall as one over the root of the samples where there is no bias: slopes of -0.5."""
    counts, series = [2**n for n in range(13)], {}

    def slope(xs, ys):
        xs, ys = [math.log(x) for x in xs], [math.log(y) for y in ys]
        mx, my = statistics.fmean(xs), statistics.fmean(ys)
        return sum((x - mx) * (y - my) for x, y in zip(xs, ys)) / sum((x - mx)**2 for x in xs)

    rows = []
    for scene in ("gradients", "edges", "spikes", "mixed"):
        for k in (1, 4, 8):
            for drawn in ("uniform", "visible"):
                errors, bands = [], []
                for count in counts:
                    # More runs where the brightest few pixels, of nine decades, make up all of the error.
                    runs = [tool(args, "film", "simulate", "-o", args.file("film.exr"), "--scene", scene, "--size", 64, 48,
                                 "--samples", count, "--seed", seed * 16 + count.bit_length(), "--wavelengths", k,
                                 "--sampling", drawn, "--spectral", "--bands", "400:700:30")
                            for seed in range(1, (16 if scene == "mixed" else 3) + 1)]
                    errors.append(math.sqrt(statistics.fmean((r["rms_xyz_error"] / r["mean_luminance"])**2 for r in runs)))
                    # A band's value is a mean of the samples that fell into it: the law holds for more than a few.
                    if count * k * 30 / 470 >= 60:
                        error = math.sqrt(statistics.fmean((r["rms_spectrum_error"] / r["mean_radiance"])**2 for r in runs))
                        bands.append((count, error))
                series[scene, k, drawn] = errors
                falls = slope(counts, errors), slope(*zip(*bands))
                rows.append([scene, drawn, k] + [f"{errors[n]:.2e}" for n in (0, 4, 8, 12)] + [f"{bands[-1][1]:.2e}"]
                            + [f"{fall:.3f} {'met' if abs(fall + 0.5) <= 0.03 else 'MISSED'}" for fall in falls])
    print("64 x 48 pixels; root mean square error of XYZ over the mean luminance, by samples a pixel; of bands of 30 nm over the "
          "mean radiance, at the most; slopes of log error over log samples\n")
    print(table(["scene", "drawn", "wavelengths", "1", "16", "256", "4096", "bands", "slope", "bands' slope"], rows))
    for (scene, k, drawn), errors in series.items():
        if drawn == "uniform":
            ratio = math.exp(statistics.fmean(2 * math.log(u / v) for u, v in zip(errors, series[scene, k, "visible"])))
            print(f"\n{scene}, {k} wavelengths: variance of uniform over that of visible sampling {ratio:.2f}", end="")
    print()
    if args.plot:
        colors = {1: "#0072b2", 4: "#d55e00", 8: "#009e73"}
        low = min(min(e) for e in series.values()) / 1.4
        end = min(4096, (0.02 / low)**2)
        guide = ("#606060", "2 3", (1, end), (0.02, 0.02 / math.sqrt(end)))
        panels = [(scene, [guide] + [(colors[k], "7 4" if drawn == "visible" else "", counts, errors)
                                     for (of, k, drawn), errors in series.items() if of == scene])
                  for scene in dict.fromkeys(key[0] for key in series)]
        keys = [(f"{k} wavelength{'s' if k > 1 else ''}", colors[k], "") for k in colors]
        line_plot(args.plot, "Error of XYZ against the exact image", "samples a pixel",
                  "root mean square error / mean luminance", (1, 4096, low, 1.4 * max(max(e) for e in series.values())),
                  keys + [("uniform", "#202020", ""), ("visible", "#202020", "7 4"), ("slope −½", "#606060", "2 3")], panels)
    return 1 if any("MISSED" in cell for row in rows for cell in row[-2:]) else 0


LIGHTS = ("D65", "A", "FL2", "FL11", "HP1", "LED-B3", "LED-RGB1")


def make_plan(args, lights, bands, sample, bounces=1, more=()):
    """Cross-validated errors of a plan: (even bands or None, light, bounces) to errors; and its processor seconds. Even bands
    are as spectile projects them, or their averages multiplied where " multiplied" follows their name."""
    if args.chart is None:
        named = [json.loads(line) for line in run([args.tool, "spectra", "--json"])[0].splitlines()]
        args.chart = [s["name"] for s in named if s["kind"] == "reflectance"]
    words = [args.tool, "plan", "--json", "-o", args.file("plan.json"), "--count", bands, "--sample", sample, "--bounces",
             bounces, "--threads", 1, *more]
    for light in lights:
        words += ["--illuminant", light]
    for name in [*args.reflectances, *args.chart]:
        words += ["--reflectances", name]
    text, _, seconds, _ = run(words)
    held_out = json.loads(text)["promise"]
    out = {}
    multiplied = [(name + " multiplied", of) for name, of in held_out["even_bands"].items()]
    for bands_text, of in [(None, held_out["illuminants"]), *held_out["even_bands_projected"].items(), *multiplied]:
        for light, errors in of.items():
            for count, error in errors.items():
                out[bands_text, light, int(count)] = error
    return out, seconds


def planning(args):
    for bounces in (1, 2) if not args.plot_only else ():
        print(f"\n{'One bounce' if bounces == 1 else 'Two bounces (planned for both)'}; CIEDE2000, mean and maximum; planned "
              "ones by five-fold cross-validation\n")
        rows = []

        def add(name, found, even=None, seconds=""):
            cells = [found[even, light, bounces] for light in LIGHTS]
            rows.append([name] + [f"{e['mean']:.3f}, {e['maximum']:.2f}" for e in cells] + [seconds])

        sixteen = make_plan(args, LIGHTS, 16, "bands", 2)
        for name, even in (("16 even, 400 to 700 nm", "400:700:18.75"), ("30 even, 400 to 700 nm", "400:700:10"),
                           ("60 even, 400 to 700 nm", "400:700:5"), ("80 even, 380 to 780 nm", "380:780:5")):
            add(name, sixteen[0], even)
            add(name + ", averages multiplied", sixteen[0], even + " multiplied")
        for count in (8, 12):
            for sample in ("points", "bands"):
                found, longest = {}, 0
                for light in LIGHTS:
                    one, seconds = make_plan(args, [light], count, sample, bounces)
                    found.update(one)
                    longest = max(longest, seconds)
                kind = "wavelengths" if sample == "points" else "bands"
                add(f"{count} {kind} planned, each light", found, None, f"{longest:.1f} s")
        for count in (12, 16):
            for sample in ("points", "bands"):
                found, seconds = sixteen if (count, sample) == (16, "bands") else make_plan(args, LIGHTS, count, sample, 2)
                kind = "wavelengths" if sample == "points" else "bands"
                add(f"{count} {kind} planned, shared", found, None, f"{seconds:.1f} s")
        print(table(["bands", *LIGHTS, "time"], rows), flush=True)
    if not args.plot:
        return
    colors, panels = {"even": "#606060", "points": "#0072b2", "bands": "#d55e00"}, []
    for light in ("D65", "A", "FL11", "HP1"):
        lines = {key: [] for key in colors}
        for sample in ("points", "bands"):
            for count in (5, 6, 8, 10, 12, 16, 20):
                found, _ = make_plan(args, [light], count, sample)
                lines[sample].append((count, found[None, light, 1]))
                for even in (count, 30, 60) if sample == "bands" and count == 20 else (count,) if sample == "bands" else ():
                    lines["even"].append((even, found[f"400:700:{300 / even:g}", light, 1]))
        panels.append((light, [(colors[key], dashes, [n for n, _ in line], [e[part] for _, e in line])
                               for key, line in lines.items() for part, dashes in (("mean", ""), ("maximum", "7 4"))]))
    line_plot(args.plot, "Colour error against number of bands, held-out reflectances", "bands",
              "CIEDE2000, mean (lines) and maximum (dashed)", (4, 100, 0.001, 40),
              [("even bands, 400 to 700 nm, as projected", colors["even"], ""), ("planned wavelengths", colors["points"], ""),
               ("planned bands", colors["bands"], "")], panels)


def texture(args, name, pattern="full", levels=0, compression="zip", image=()):
    run([args.exr, "texture", args.file(name), args.size, pattern, levels, compression, *image])
    return args.file(name)


def planned(args):
    image = texture(args, "texture.exr")
    plain = texture(args, "plain.exr", compression="none")
    found, _ = make_plan(args, ["D65"], args.bands, "bands", more=["--texture", image, "--colors", 160])
    plan = args.file("plan.json")
    print(f"{args.size} x {args.size} texture, D65, half; held-out CIEDE2000, mean (maximum): " + "; ".join(
        f"{even or f'{args.bands} planned bands'} {e['mean']:.3f} ({e['maximum']:.2f})" for (even, _, _), e in found.items()) + "\n")
    rows = []
    for compression in ("none", "zip:1", "zip:4", "piz"):
        seconds, size, errors = {}, {}, {}
        for _ in range(args.runs):
            for name, more in (("even", ()), ("planned", ("--bands", plan))):
                r = tool(args, "upsample", image, "-o", args.file(name + ".exr"), "--compression", compression, *more)
                seconds.setdefault(name, []).append(r["seconds"])
                size[name] = r["bytes_written"] * 1e-6
        for name in seconds:
            tool(args, "project", args.file(name + ".exr"), "-o", args.file("back.exr"), "--compression", "none")
            differences = list(color_errors(plain, args.file("back.exr"), 64, 17))
            errors[name] = f"{statistics.fmean(differences):.4f}, {max(differences):.3f}"
        even, plan_s = (statistics.median(seconds[name]) for name in ("even", "planned"))
        rows.append([compression, f"{even:.2f}", f"{size['even']:.0f}", f"{plan_s:.2f}", f"{size['planned']:.0f}",
                     f"{even / plan_s:.1f}", f"{size['even'] / size['planned']:.1f}", errors["even"], errors["planned"]])
    print(table(["compression", "60 even: s", "MB", "planned: s", "MB", "faster", "smaller", "round trip, 60 even", "planned"],
                rows))


def skipping(args):
    full, quadrant, islands = (texture(args, name + ".exr", name) for name in ("full", "quadrant", "islands"))
    eight = texture(args, "eight_bits.exr", "full", 255)
    sigmoid = ("--method", "sigmoid", "--compression", "none")
    cases = [("full", full, ()), ("three quarters black, one quadrant used", quadrant, ()),
             ("three quarters black, islands of 256 x 256", islands, ()), ("full, --tile 256 256", full, ("--tile", 256, 256)),
             ("islands, --tile 256 256", islands, ("--tile", 256, 256)),
             ("three quarters masked, colours beneath", full, ("--mask", quadrant)), ("full, --no-skip", full, ("--no-skip",)),
             ("one quadrant used, --no-skip", quadrant, ("--no-skip",)), ("8-bit colours, sigmoid", eight, sigmoid),
             ("8-bit colours, sigmoid, --no-skip", eight, (*sigmoid, "--no-skip"))]
    found = {name: [] for name, _, _ in cases}
    for _ in range(args.runs):
        for name, image, more in cases:
            found[name].append(tool(args, "upsample", image, "-o", args.file("out.exr"), *more))
    print(f"{args.size} x {args.size}, 60 half bands, zip:1 (sigmoid: none), the least of {args.runs} runs\n")
    rows = []
    for name, runs in found.items():
        best, skipped, first = min(r["seconds"] for r in runs), runs[-1]["skipped"], min(r["seconds"] for r in found["full"])
        solved, pixels = skipped["colors_solved"], runs[-1]["width"] * runs[-1]["height"]
        rows.append([name, f"{best:.2f}", "" if "sigmoid" in name else f"{first / best:.1f} times as fast",
                     f"{runs[-1]['bytes_written'] * 1e-6:.0f}", f"{skipped['chunks_reused']} of {skipped['chunks']}",
                     f"{solved} of {pixels}, {pixels / solved:.0f} times fewer" if solved else ""])
    print(table(["texture", "s", "against full", "MB", "chunks reused", "colours solved, of pixels"], rows))


def end_to_end(args):
    image = texture(args, "texture.exr", image=args.image)
    planes, ours, theirs = args.file("planes.exr"), args.file("ours.exr"), args.file("theirs.exr")
    tool(args, "upsample", image, "-o", planes, "--compression", "none")
    rows = []
    for compression in ("none", "piz", "zip:1", "zip:4"):
        seconds, alone, peak = [], [], 0
        for _ in range(args.runs):
            _, wall, _, memory = run([args.tool, "upsample", image, "-o", ours, "--compression", compression, "--threads",
                                      args.threads, "--quiet"])
            seconds.append(wall)
            peak = max(peak, memory)
            alone.append(float(run([args.exr, "write", planes, theirs, compression, args.threads])[0]))
        a, b = statistics.median(seconds), statistics.median(alone)
        rows.append([compression, f"{a:.2f}", f"{b:.2f}", f"{a / b:.2f}", f"{args.size**2 * 1e-6 / a:.2f}",
                     f"{os.path.getsize(ours) * 1e-6:.0f}", f"{peak:.0f}", "met" if a <= 1.15 * b and peak < 400 else "MISSED"])
    print(table(["", "spectile, s", "OpenEXR alone, s", "ratio", "spectile, Mpixel/s", "size, MB", "peak, MB",
                 "ratio at most 1.15, peak under 400 MB"], rows))
    return 1 if any(row[-1] == "MISSED" for row in rows) else 0


def compression(args):
    methods = "none rle zips:1 zips:4 zip:1 zip:2 zip:3 zip:4 zip:5 zip:6 zip:9 piz pxr24 b44 b44a dwaa dwab".split()
    found = {method: [] for method in methods}
    for _ in range(args.runs):
        for method in methods:
            found[method].append(tool(args, "upsample", args.image, "-o", args.file("out.exr"), "--compression", method,
                                      "--nonfinite", "zero"))
    pixels, none = found["none"][0]["width"] * found["none"][0]["height"], found["none"][0]["bytes_written"]
    print(table(["compression", "Mpixel/s", "bytes/pixel", "size against none"],
                [[f"`{method}`", f"{pixels / statistics.median(r['seconds'] for r in runs) * 1e-6:.2f}",
                  f"{runs[0]['bytes_written'] / pixels:.1f}", f"{100 * runs[0]['bytes_written'] / none:.0f} %"]
                 for method, runs in found.items()]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    options = {
        "--plot": {"help": "also draw an SVG"}, "--plot-only": {"action": "store_true", "help": "no tables"},
        "--reflectances": {"action": "append", "default": [], "help": "file of measured reflectances; may be repeated"},
        "--size": {"type": int, "default": 4096}, "--runs": {"type": int, "default": 3}, "--bands": {"type": int, "default": 7},
        "--side": {"type": int, "default": 65}, "--gamut-side": {"type": int, "default": 33},
        "--image": {"nargs": 1, "default": [], "help": "an image repeated over the texture, in place of noise"},
        "--exr": {"default": "build/bench/spectile_bench_exr"}}
    for name, wanted in (("convergence", ["--plot"]), ("planning", ["--plot", "--plot-only", "--reflectances"]),
                         ("planned", ["--size", "--runs", "--bands", "--reflectances", "--exr"]),
                         ("skipping", ["--size", "--runs", "--exr"]), ("end-to-end", ["--size", "--runs", "--image", "--exr"]),
                         ("compression", ["--runs"]), ("methods", ["--side", "--gamut-side", "--plot", "--plot-only", "--reflectances"])):
        command = commands.add_parser(name)
        command.add_argument("--tool", default="build/spectile", help="the spectile command (build/spectile)")
        command.add_argument("--threads", type=int, default=1 if name == "compression" else 2)
        for option in wanted:
            command.add_argument(option, **options[option])
        if name == "compression":
            command.add_argument("image")
    command = commands.add_parser("report")
    command.add_argument("report")
    command.add_argument("page", nargs="+")
    args = parser.parse_args()
    args.chart = None
    with tempfile.TemporaryDirectory(prefix="spectile-figures-") as folder:
        args.file = lambda name: os.path.join(folder, name)
        return globals()[args.command.replace("-", "_")](args)


if __name__ == "__main__":
    sys.exit(main())
