"""Processes, Markdown tables, line plots, uncompressed OpenEXR images and colour differences, for figures.py."""
import array
import json
import math
import os
import struct
import subprocess
import sys
import tempfile
import time


def run(command):
    """Output, wall seconds, processor seconds and peak megabytes of a command; ends the script where it fails."""
    start = time.monotonic()
    with tempfile.TemporaryFile("w+") as out:
        child = subprocess.Popen([str(word) for word in command], stdout=out)
        _, status, usage = os.wait4(child.pid, 0)
        wall = time.monotonic() - start
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode != 0:
            sys.exit(f"figures: {' '.join(map(str, command))}: exit code {child.returncode}")
        out.seek(0)
        return out.read(), wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024e-6


def tool(args, *words):
    """The JSON that `spectile WORDS --json` prints."""
    return json.loads(run([args.tool, *words, "--json", "--threads", args.threads])[0])


def table(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|" + "|".join(["---"] + ["---:"] * (len(heads) - 1)) + "|"]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def line_plot(path, title, x_label, y_label, ends, keys, panels):
    """Panels, two a row, of lines over two logarithmic axes. A line: (colour, dashes, xs, ys), or with a label near its
    first point: (words, right of it, below it, anchor); a key: (label, colour, dashes); ends: x0, x1, y0, y1."""
    width, height, left, right, top, bottom, apart_x, apart_y = 900, 620, 72, 18, 84, 56, 60, 44
    x0, x1, y0, y1 = ends
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
           'font-family="DejaVu Sans, Verdana, Arial, sans-serif" fill="#202020">',
           f'<rect width="{width}" height="{height}" fill="#ffffff"/>']

    def text(x, y, anchor, size, words, more=""):
        out.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size}"{more}>{words}</text>')

    def segment(a, b, c, d, stroke):
        out.append(f'<line x1="{a:.1f}" y1="{b:.1f}" x2="{c:.1f}" y2="{d:.1f}" {stroke}/>')

    def stroke_of(color, dashes):
        more = f' stroke-dasharray="{dashes}"' if dashes else ""
        return f'fill="none" stroke="{color}" stroke-width="{1 if dashes == "2 3" else 2}"{more}'

    def ruled(low, high):
        for power in range(math.floor(math.log10(low)), math.floor(math.log10(high)) + 1):
            for digit in range(1, 10):
                if low * 0.999 <= digit * 10.0**power <= high * 1.001:
                    yield digit * 10.0**power, "#cfcfcf" if digit == 1 else "#efefef", \
                        "" if digit > 1 else f"{10.0**power:g}" if abs(power) <= 3 else \
                        f'10<tspan dy="-5" font-size="10">{power}</tspan>'

    text(width / 2, 26, "middle", 17, title)
    x = (width + 18 - sum(54 + 7.6 * len(label) for label, _, _ in keys)) / 2
    for label, color, dashes in keys:
        segment(x, 48, x + 30, 48, stroke_of(color, dashes))
        text(x + 36, 52, "start", 13, label)
        x += 54 + 7.6 * len(label)
    rows = (len(panels) + 1) // 2
    w, h = (width - left - right - apart_x) / 2, (height - top - bottom - apart_y * (rows - 1)) / rows
    for index, (name, lines) in enumerate(panels):
        bx, by = left + index % 2 * (w + apart_x), top + index // 2 * (h + apart_y)

        def at(v, bx=bx):
            return bx + w * math.log(v / x0) / math.log(x1 / x0)

        def up(v, by=by):
            return by + h * math.log(y1 / v) / math.log(y1 / y0)

        for v, color, label in ruled(x0, x1):
            segment(at(v), by, at(v), by + h, f'stroke="{color}"')
            text(at(v), by + h + 16, "middle", 12, label)
        for v, color, label in ruled(y0, y1):
            segment(bx, up(v), bx + w, up(v), f'stroke="{color}"')
            text(bx - 7, up(v) + 4, "end", 12, label)
        out.append(f'<rect x="{bx:.1f}" y="{by:.1f}" width="{w:.1f}" height="{h:.1f}" fill="none" stroke="#808080"/>')
        text(bx + 4, by - 6, "start", 14, name, ' font-weight="bold"')
        for color, dashes, xs, ys, *label in lines:
            points = [(at(a), up(b)) for a, b in zip(xs, ys)]
            out.append(f'<polyline points="{" ".join(f"{a:.1f},{b:.1f}" for a, b in points)}" {stroke_of(color, dashes)}/>')
            if dashes != "2 3":
                out += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="2.4" fill="{color}"/>' for a, b in points]
            for words, right, below, anchor in label:
                text(points[0][0] + right, points[0][1] + below, anchor, 11, words)
    text(left + (width - left - right) / 2, height - 14, "middle", 14, x_label)
    middle = top + (height - top - bottom) / 2
    text(20, middle, "middle", 14, y_label, f' transform="rotate(-90 20 {middle:.1f})"')
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(out) + "\n</svg>\n")


class Image:
    """An uncompressed scanline OpenEXR image of half and float channels, read line by line."""

    def __init__(self, path):
        self.file = open(path, "rb")  # read as long as the object lives
        data = self.file.read(1 << 20)
        at, self.channels, attributes = 8, [], {}
        while data[at] != 0:
            name, kind = data[at:at + 512].split(b"\0")[:2]
            at += len(name) + len(kind) + 2
            size = struct.unpack_from("<i", data, at)[0]
            attributes[name] = data[at + 4:at + 4 + size]
            at += 4 + size
        if attributes[b"compression"] != b"\0":
            sys.exit(f"figures: {path} is compressed")
        entry, channels = 0, attributes[b"channels"]
        while channels[entry] != 0:
            end = channels.index(b"\0", entry)
            self.channels.append((channels[entry:end].decode(), "I e f".split()[struct.unpack_from("<i", channels, end + 1)[0]]))
            entry = end + 17
        x_min, y_min, x_max, y_max = struct.unpack("<4i", attributes[b"dataWindow"])
        self.width, self.height = x_max - x_min + 1, y_max - y_min + 1
        self.offsets = struct.unpack_from(f"<{self.height}Q", data, at + 1)

    def line(self, y):
        """Samples of a line by channel."""
        self.file.seek(self.offsets[y] + 8)
        data = self.file.read(sum(self.width * struct.calcsize(kind) for _, kind in self.channels))
        out, at = {}, 0
        for name, kind in self.channels:
            out[name] = struct.unpack_from(f"<{self.width}{kind}", data, at)
            at += self.width * struct.calcsize(kind)
        return out


def write_image(path, width, height, lines):
    """A float RGB image; lines: for each, its R, G and B."""
    def attribute(name, kind, data):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    channels = b"".join(name + struct.pack("<xiB3x2i", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    head = struct.pack("<2i", 20000630, 2) + b"".join([
        attribute(b"channels", b"chlist", channels), attribute(b"compression", b"compression", b"\0"),
        attribute(b"dataWindow", b"box2i", window), attribute(b"displayWindow", b"box2i", window),
        attribute(b"lineOrder", b"lineOrder", b"\0"), attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
        attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0)),
        attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1))]) + b"\0"
    bytes_a_line = 12 * width
    with open(path, "wb") as file:
        file.write(head)
        first = len(head) + 8 * height
        file.write(struct.pack(f"<{height}Q", *(first + y * (8 + bytes_a_line) for y in range(height))))
        for y, (r, g, b) in enumerate(lines):
            file.write(struct.pack("<2i", y, bytes_a_line))
            for plane in (b, g, r):
                array.array("f", plane).tofile(file)


SRGB_TO_XYZ = ((0.4123907992659595, 0.35758433938387796, 0.1804807884018343),
               (0.21263900587151036, 0.7151686787677559, 0.07219231536073371),
               (0.01933081871559185, 0.11919477979462598, 0.9505321522496606))


def lab_of_srgb(rgb):
    """CIELAB of linear sRGB, under its white."""
    def f(t):
        return math.cbrt(t) if t > 216 / 24389 else (24389 / 27 * t + 16) / 116
    x, y, z = (f(sum(m * v for m, v in zip(row, rgb)) / sum(row)) for row in SRGB_TO_XYZ)
    return 116 * y - 16, 500 * (x - y), 200 * (y - z)


def ciede2000(first, second):
    """Source: Sharma, Wu, Dalal, The CIEDE2000 Color-Difference Formula, 2005."""
    (l1, a1, b1), (l2, a2, b2) = first, second
    c7 = ((math.hypot(a1, b1) + math.hypot(a2, b2)) / 2)**7
    g = 1.5 - 0.5 * math.sqrt(c7 / (c7 + 25**7))
    c1, c2 = math.hypot(g * a1, b1), math.hypot(g * a2, b2)
    h1, h2 = math.atan2(b1, g * a1) % math.tau, math.atan2(b2, g * a2) % math.tau
    dh = 0 if c1 * c2 == 0 else (h2 - h1 + math.pi) % math.tau - math.pi
    h = h1 + h2 if c1 * c2 == 0 else h1 + dh / 2
    l, c, big = (l1 + l2) / 2, (c1 + c2) / 2, 2 * math.sqrt(c1 * c2) * math.sin(dh / 2)
    t = (1 - 0.17 * math.cos(h - math.pi / 6) + 0.24 * math.cos(2 * h) + 0.32 * math.cos(3 * h + math.radians(6))
         - 0.2 * math.cos(4 * h - math.radians(63)))
    sl = 1 + 0.015 * (l - 50)**2 / math.sqrt(20 + (l - 50)**2)
    sc, sh = 1 + 0.045 * c, 1 + 0.015 * c * t
    turn = math.radians(60) * math.exp(-((math.degrees(h) % 360 - 275) / 25)**2)
    rt = -2 * math.sqrt(c**7 / (c**7 + 25**7)) * math.sin(turn)
    dl, dc = (l2 - l1) / sl, (c2 - c1) / sc
    return math.sqrt(max(0.0, dl * dl + dc * dc + (big / sh)**2 + rt * dc * big / sh))


def color_errors(before, after, lines=1, columns=1):
    """CIEDE2000 between two images' R, G, B, every so many lines and columns."""
    a, b = Image(before), Image(after)
    for y in range(0, a.height, lines):
        rows = [[line[name] for name in "RGB"] for line in (a.line(y), b.line(y))]
        for x in range(0, a.width, columns):
            yield ciede2000(*(lab_of_srgb([plane[x] for plane in row]) for row in rows))
