#!/usr/bin/env python3
"""Makes the README's picture from the demo's images: the chart, the spectra of its corners, the chart come back.

usage: tools/make_picture.py SPECTILE DEMO_DIR OUT.png     (needs ImageMagick with OpenEXR)
"""
import json
import os
import subprocess
import sys

tool, demo, out = sys.argv[1:4]
W, H = 1240, 330
LEFT, TOP, PW, PH = 440, 30, 360, 250  # the plot


def pixel(x, y):
    text = subprocess.check_output([tool, "info", f"{demo}/chart-spectral.exr", "--pixel", f"{x},{y}", "--json"])
    return json.loads(text)


info = json.loads(subprocess.check_output([tool, "info", f"{demo}/chart-spectral.exr", "--json"]))
method = info["attributes"]["spectileMethod"]


def curve(values, top):
    n = len(values)
    points = [(LEFT + PW * (i + 0.5) / n, TOP + PH * (1 - v / top)) for i, v in enumerate(values)]
    return [f"line {a[0]:.1f},{a[1]:.1f} {b[0]:.1f},{b[1]:.1f}" for a, b in zip(points, points[1:])]


# The lowest row of the chart holds the cube's eight corners: black, blue, green, cyan, red, magenta, yellow, white.
colours = ["#000000", "#2040ff", "#00a020", "#00a8b0", "#e02020", "#d020c0", "#c0a000", "#808080"]
draw = []
for corner, colour in enumerate(colours):
    if corner == 0:
        continue
    values = pixel(int((corner + 0.5) * 1536 / 8), 1000)["pixel"]
    draw += ["-stroke", colour, "-strokewidth", "2.5"]
    for line in curve(values, 1.1):
        draw += ["-draw", line]
axis = ["-fill", "none", "-stroke", "#404040", "-strokewidth", "1",
        "-draw", f"line {LEFT},{TOP + PH} {LEFT + PW},{TOP + PH}", "-draw", f"line {LEFT},{TOP} {LEFT},{TOP + PH}"]
# ImageMagick's own font comes with Ghostscript, which may be missing.
font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
text = [*(["-font", font] if os.path.exists(font) else []), "-stroke", "none", "-fill", "#303030", "-pointsize", "14"]
for value in (0, 0.5, 1):
    text += ["-draw", f"text {LEFT - 30},{TOP + PH * (1 - value / 1.1) + 5} '{value}'"]
for nm in (400, 500, 600, 700):
    text += ["-draw", f"text {LEFT + PW * (nm - 400) / 300 - 12},{TOP + PH + 20} '{nm}'"]
text += ["-draw", f"text 20,{TOP + 290} 'RGB texture'",
         "-draw", f"text {LEFT + 30},{TOP + 290} 'spectra of its corners by {method} (nm)'",
         "-draw", f"text {LEFT + PW + 50},{TOP + 290} 'projected back under D65'"]
scale = ["-resize", "375x250", "-colorspace", "sRGB"]
subprocess.check_call(
    ["convert", "-size", f"{W}x{H}", "xc:white",
     "(", f"{demo}/chart.exr", "-channel", "RGB", *scale, ")", "-geometry", f"+20+{TOP}", "-composite",
     "(", f"{demo}/chart-back.exr", "-channel", "RGB", *scale, ")", "-geometry", f"+{LEFT + PW + 50}+{TOP}",
     "-composite", *draw, *axis, *text, "-depth", "8", "-define", "png:compression-level=9", out])
