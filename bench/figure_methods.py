"""The methods from RGB to spectra: round trips, gamuts, measured reflectances under other lights."""
import json
import math
import random
import statistics

from figure_tools import Image, color_errors, line_plot, run, table, tool, write_image

METHODS = ("smits", "smits1999", "smits-exact", "mallett", "sigmoid", "sigmoid-observer", "tetrahedral")


def grid(path, side):
    """All colours of a grid over the RGB cube, a line for each blue and green."""
    steps = [i / (side - 1) for i in range(side)]
    write_image(path, side, side * side, ((steps, [g] * side, [b] * side) for b in steps for g in steps))
    return path


def tables(args):
    cube, spectra, back = grid(args.file("cube.exr"), args.side), args.file("spectra.exr"), args.file("back.exr")
    rows = []
    for method in METHODS:
        tool(args, "upsample", cube, "-o", spectra, "--method", method, "--depth", "float", "--compression", "none")
        tool(args, "project", spectra, "-o", back, "--compression", "none")
        channel, low, high, rough = 0, 1, 0, []
        a, b, image = Image(cube), Image(back), Image(spectra)
        for y in range(a.height):
            before, after, line = a.line(y), b.line(y), image.line(y)
            channel = max(channel, *(abs(p - q) for name in "RGB" for p, q in zip(before[name], after[name])))
            bands = [line[name] for name in sorted(n for n in line if n.endswith("nm"))]
            low, high = min(low, *map(min, bands)), max(high, *map(max, bands))
            for s in zip(*bands):
                rough.append(math.sqrt(sum((s[i - 1] - 2 * s[i] + s[i + 1])**2 for i in range(1, len(s) - 1))))
        colors = list(color_errors(cube, back))
        rows.append([f"`{method}`", f"{channel:.1e}", f"{statistics.fmean(colors):.1e}, {max(colors):.1e}",
                     f"{low:.3g} to {high:.6g}", f"{statistics.fmean(rough):.3f}, {max(rough):.3f}"])
    print(f"Round trip of a {args.side}^3 grid of linear sRGB, 60 bands, float throughout. Roughness: root of the sum of squared "
          "second differences over the bands.\n")
    print(table(["method", "largest error of a channel", "CIEDE2000 mean, max", "samples", "roughness mean, max"], rows))
    print(f"\nReflectances: share of a {args.gamut_side}^3 grid of each space that a method covers, and the CIEDE2000 that clipping "
          "the others along their dominant wavelength costs, mean of those and maximum\n")
    cube, rows = grid(args.file("gamut.exr"), args.gamut_side), []
    for space in ("srgb", "display-p3", "adobe-rgb", "rec2020", "acescg", "aces2065-1"):
        row = [space]
        for method in ("smits-exact", "sigmoid", "sigmoid-observer"):
            words = ("upsample", cube, "--input-space", space, "--method", method, "--depth", "float", "--compression", "none")
            tool(args, *words, "-o", args.file("kept.exr"), "--out-of-gamut", "keep")
            outside = tool(args, *words, "-o", args.file("clipped.exr"), "--out-of-gamut", "clip")["out_of_gamut_pixels"]
            moved = [e for e in color_errors(args.file("kept.exr"), args.file("clipped.exr")) if e > 1e-4] or [0]
            row += [f"{100 - 100 * outside / args.gamut_side**3:.1f} %", f"{statistics.fmean(moved):.2f}, {max(moved):.1f}"]
        rows.append(row)
    print(table(["input space", *(word for m in ("smits-exact", "sigmoid", "sigmoid-observer") for word in (f"`{m}` covers", "costs"))], rows))


def methods(args):
    if not args.plot_only:
        tables(args)
    measured(args, ("A", "FL2", "FL11", "LED-B3", "HP1"), ("60 even bands", "80 even bands to 780 nm"), [])
    if args.plot_only:
        return
    spectra = map(json.loads, run([args.tool, "spectra", "--json"])[0].splitlines())
    named = [spectrum["name"] for spectrum in spectra if spectrum["kind"] == "illuminant"]
    measured(args, named, ("60 even bands",), ["--quick"])


def measured(args, lights, lists, more):
    """Errors of methods over measured reflectances, with bootstrapped errors of their means."""
    words = [args.tool, "bench", "--json", "--differences", "-q", "--cache-only", "--threads", 1, "--illuminant", ",".join(lights), *more]
    for file in args.reflectances:
        words += ["--reflectances", file]
    ways = json.loads(run(words)[0])["ways"]
    of = {(w["light"], w["name"]): w["differences"] for w in ways}
    if args.plot and len(lights) <= 5:
        plot(args.plot, ways, lights, lists[0])
    count = len(of[lights[0], f"smits, {lists[0]}, fused"])
    draw = random.Random(1)
    drawn = [[draw.randrange(count) for _ in range(count)] for _ in range(1000)]

    def deviation(values):  # of their mean, over samples drawn with replacement
        return statistics.stdev(statistics.fmean(values[i] for i in places) for places in drawn)
    for bands in lists:
        print(f"\nMeasured reflectances under {len(lights)} other lights, from their RGB under D65 (clipped to sRGB's cube), {bands}; CIEDE2000 "
              "against sums at every nanometre, mean and maximum; ±: standard deviation of the mean, and of its difference to the next "
              "row's, bootstrapped\n")
        means = {}
        for method in METHODS:
            name = f"{method}, {bands}, fused"
            if (lights[0], name) in of:
                means[method] = [statistics.fmean(of[light, name][i] for light in lights) for i in range(count)]
        order = sorted(means, key=lambda method: -statistics.fmean(means[method]))
        rows = []
        for method, following in zip(order, order[1:] + [None]):
            row = [of[light, f"{method}, {bands}, fused"] for light in lights]
            shown = row if len(lights) <= 5 else []
            difference = [p - q for p, q in zip(means[method], means[following])] if following else []
            rows.append([f"`{method}`"] + [f"{statistics.fmean(e):.2f}, {max(e):.1f}" for e in shown]
                        + [f"{statistics.fmean(means[method]):.3f} ± {deviation(means[method]):.3f}", f"{max(map(max, row)):.1f}",
                           f"{statistics.fmean(difference):.3f} ± {deviation(difference):.3f}" if following else ""])
        print(table(["method", *(lights if len(lights) <= 5 else []), "mean of all", "max", "less the next"], rows))


# Of others, on the reflectances and lights of docs/methods.md: their mean errors, from there. They were not timed.
OTHERS = (("LHTSS (Burns 2020)", 1.216), ("Otsu et al. 2018", 1.464))

# Of labels, where they do not overlap: right of a point, below it, anchor.
PLACES = {"smits": (6, -6, "start"), "mallett": (6, 4, "start"), "smits-exact": (6, 8, "start"), "sigmoid": (-6, -4, "end"),
          "sigmoid-observer": (-2, 30, "end"), "tetrahedral": (6, 15, "start")}


def plot(path, ways, lights, bands):
    """Error under other lights against the cost of a pixel, for spectra in memory and for relighting without them."""
    panels = []
    for title, kind in ((f"Through spectra in memory, {bands}", "spectra in float"), (f"Relighting, {bands}", "fused")):
        lines = [("#606060", "2 3", [0.1, 100], [mean, mean], (name, 6, -4, "start")) for name, mean in OTHERS]
        for method in METHODS:
            found = [w for w in ways if w["name"] == f"{method}, {bands}, {kind}"]
            if not found:
                continue
            nanoseconds = statistics.median(w["nanoseconds"] for w in found)
            mean = statistics.fmean(statistics.fmean(w["differences"]) for w in found)
            largest = max(max(w["differences"]) for w in found)
            color = "#d55e00" if method == "tetrahedral" else "#0072b2"
            lines.append((color, "", [nanoseconds] * 2, [mean, largest], (method, *PLACES[method])))
        panels.append((title, lines))
    line_plot(path, f"Error under {len(lights)} other lights against cost, from RGB under D65", "nanoseconds a pixel, one thread",
              "CIEDE2000, mean (named) and largest", (0.1, 100, 0.5, 20),
              [("spectile's methods", "#0072b2", ""), ("the default", "#d55e00", ""), ("others' means, not timed", "#606060", "2 3")], panels)
