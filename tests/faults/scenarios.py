"""Commands on small images that are run with faults, and what each of them may leave behind."""
import dataclasses
import json
import os
import random
import shutil
import struct

from tool import copy_folder, read_folder

OLD = b"an old file, which stays whole until the new one replaces it\n"
OLD_LINE = b'{"input":"old.exr","status":"converted"}\n'


def write_rgb(path, width, height, seed):
    """An OpenEXR image of three float channels, uncompressed, of random values."""
    draw = random.Random(seed)

    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    channels = b"".join(name + b"\0" + struct.pack("<iBxxxii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    # Primaries of linear Rec. 709, so that no guess about them is printed.
    primaries = struct.pack("<8f", 0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290)
    header = b"".join([
        struct.pack("<2i", 20000630, 2), attribute("channels", "chlist", channels), attribute("compression", "compression", b"\0"),
        attribute("chromaticities", "chromaticities", primaries), attribute("dataWindow", "box2i", window),
        attribute("displayWindow", "box2i", window), attribute("lineOrder", "lineOrder", b"\0"),
        attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1)), b"\0"])
    line_bytes = 3 * 4 * width
    first = len(header) + 8 * height
    with open(path, "wb") as file:
        file.write(header)
        file.write(struct.pack(f"<{height}Q", *(first + y * (8 + line_bytes) for y in range(height))))
        for y in range(height):
            file.write(struct.pack("<2i", y, line_bytes))
            file.write(struct.pack(f"<{3 * width}f", *(draw.random() for _ in range(3 * width))))


FILM = ["film", "simulate", "--size", "16", "16", "--samples", "4", "--threads", "2", "--quiet"]
# Long enough for some checkpoints: a film is saved between stretches of about a million samples.
LONG_FILM = ["film", "simulate", "--size", "8", "8", "--samples", "40000", "--wavelengths", "1", "--threads", "2", "--quiet",
             "--every", "0"]


def make_inputs(tool, folder):
    """All that the scenarios read."""
    def run(*arguments, fault=None):
        outcome = tool.run([*arguments], folder, fault)
        if fault is None and outcome.exit != 0:
            raise RuntimeError(f"inputs cannot be made: {arguments}: {outcome.exit} {outcome.err}")

    for i, name in enumerate(("in.exr", "a.exr", "b.exr", "c.exr")):
        write_rgb(os.path.join(folder, name), 16, 16, i)
    run("upsample", "in.exr", "-o", "spectral.exr", "--bands", "400:700:20", "--quiet")
    run("upsample", "in.exr", "-o", "coefficients.exr", "--store", "coefficients", "--bands", "400:700:20", "--quiet")
    for shard in (0, 1):
        run(*FILM, "--shard", f"{shard}/2", "-o", f"film{shard}.exr")
    run("film", "develop", "film0.exr", "-o", "image0.exr", "--quiet")
    run("film", "develop", "film1.exr", "-o", "image1.exr", "--quiet")
    # A run whose second checkpoint does not get its name leaves the first one.
    run(*LONG_FILM, "-o", "unfinished.exr", "--checkpoint", "saved.exr", fault="rename:2")
    if not os.path.exists(os.path.join(folder, "saved.exr")):
        raise RuntimeError("inputs cannot be made: no checkpoint was left")


def is_image(tool, folder, path, _old):
    """A checkpoint holds one of many states: it is whole where it can be developed."""
    developed = ".developed.exr"
    outcome = tool.run(["film", "develop", path, "-o", developed, "--quiet"], folder)
    if os.path.exists(os.path.join(folder, developed)):
        os.unlink(os.path.join(folder, developed))
    return outcome.exit == 0


def is_manifest(_tool, folder, path, old):
    """Whole lines behind the old ones; the last may be cut short, which the next run says."""
    with open(os.path.join(folder, path), "rb") as file:
        text = file.read()
    if old is not None and not text.startswith(old):
        return False
    lines = text[len(old or b""):].split(b"\n")
    try:
        return all(isinstance(json.loads(line), dict) for line in lines[:-1] if line)
    except ValueError:
        return False


def is_page(_tool, folder, path, _old):
    """A report holds times, so that no two are alike."""
    with open(os.path.join(folder, path), "rb") as file:
        return file.read().rstrip().endswith(b"</html>")


def manifest_entries(text):
    """A finished manifest without what differs from run to run."""
    lines = [json.loads(line) for line in text.decode().splitlines()]
    for line in lines:
        line.pop("seconds", None)
    return lines


@dataclasses.dataclass
class Scenario:
    name: str
    arguments: list
    inputs: list
    targets: list  # files that it writes; checkpoints, manifests and reports in `special`
    special: dict = dataclasses.field(default_factory=dict)  # path: function that says if it is whole
    old: dict = dataclasses.field(default_factory=dict)  # contents of targets before, where not OLD
    jobs: int = 1  # most lines of errors
    prints: bool = False  # its result is what it prints

    def prepare(self, inputs, folder, with_old):
        """Lays out a folder for a run."""
        os.makedirs(folder)
        for name in self.inputs:
            target = os.path.join(folder, name)
            with open(os.path.join(inputs, name), "rb") as source, open(target, "wb") as file:
                file.write(source.read())
        if not with_old:
            return
        for path in [*self.targets, *self.special]:
            contents = self.old.get(path, OLD)
            if contents is None:
                continue
            os.makedirs(os.path.dirname(os.path.join(folder, path)), exist_ok=True)
            with open(os.path.join(folder, path), "wb") as file:
                file.write(contents)


class UpdateScenario(Scenario):
    """Of three outputs one is up to date, one of other settings, and one is missing or damaged."""

    def build(self, tool, inputs, folder):
        super().prepare(inputs, folder, False)
        for arguments in (["a.exr"], ["b.exr", "--depth", "float"]):
            outcome = tool.run(["upsample", *arguments, "-o", "out/", "--quiet"], folder)
            if outcome.exit != 0:
                raise RuntimeError(f"{self.name} cannot be prepared: {outcome.err}")

    def prepare(self, inputs, folder, with_old):
        copy_folder(os.path.join(inputs, self.name), folder)
        if with_old:
            with open(os.path.join(folder, "out/c.exr"), "wb") as file:
                file.write(OLD)


def all_scenarios(tool, inputs):
    """The scenarios, with their inputs made in a folder."""
    make_inputs(tool, inputs)
    threads = ["--threads", "2"]
    small = ["--bands", "400:700:20", *threads]
    with open(os.path.join(inputs, "saved.exr"), "rb") as file:
        saved = file.read()
    update = UpdateScenario("upsample-update", ["upsample", "a.exr", "b.exr", "c.exr", "-o", "out/", "--update", *threads],
                            ["a.exr", "b.exr", "c.exr"], ["out/a.exr", "out/b.exr", "out/c.exr"], jobs=3)
    update.build(tool, inputs, os.path.join(inputs, update.name))
    return [
        Scenario("upsample", ["upsample", "in.exr", "-o", "out.exr", "--compression", "zip", *small], ["in.exr"], ["out.exr"]),
        Scenario("upsample-tiled", ["upsample", "in.exr", "-o", "out.exr", "--tile", "8", "8", "--mipmap", *small], ["in.exr"],
                 ["out.exr"]),
        Scenario("upsample-folder", ["upsample", "a.exr", "b.exr", "c.exr", "-o", "out/", "--manifest", "m.jsonl", *small],
                 ["a.exr", "b.exr", "c.exr"], ["out/a.exr", "out/b.exr", "out/c.exr"], {"m.jsonl": is_manifest},
                 {"m.jsonl": OLD_LINE}, jobs=3),
        update,
        Scenario("project", ["project", "spectral.exr", "-o", "out.exr", *threads], ["spectral.exr"], ["out.exr"]),
        Scenario("relight", ["relight", "in.exr", "-o", "out.exr", "--illuminant", "A", *small], ["in.exr"], ["out.exr"]),
        Scenario("convert", ["convert", "spectral.exr", "-o", "out.exr", "--bands", "400:700:60", *threads], ["spectral.exr"],
                 ["out.exr"]),
        Scenario("expand", ["expand", "coefficients.exr", "-o", "out.exr", *threads], ["coefficients.exr"], ["out.exr"]),
        Scenario("plan", ["plan", "--illuminant", "D65", "--texture", "in.exr", "--count", "3", "--folds", "0", "-o", "plan.json",
                          *threads], ["in.exr"], ["plan.json"]),
        Scenario("film-simulate", [*LONG_FILM, "-o", "film.exr", "--checkpoint", "check.exr", "--reference", "exact.exr"], [],
                 ["film.exr", "exact.exr"], {"check.exr": is_image}, {"check.exr": saved}),
        Scenario("film-merge", ["film", "merge", "film0.exr", "film1.exr", "-o", "all.exr", *threads], ["film0.exr", "film1.exr"],
                 ["all.exr"]),
        Scenario("film-develop", ["film", "develop", "film0.exr", "-o", "image.exr", *threads], ["film0.exr"], ["image.exr"]),
        Scenario("film-average", ["film", "average", "image0.exr", "image1.exr", "-o", "mean.exr", *threads],
                 ["image0.exr", "image1.exr"], ["mean.exr"]),
        Scenario("info", ["info", "spectral.exr", "--pixel", "3,4"], ["spectral.exr"], [], prints=True),
        Scenario("validate", ["validate", "spectral.exr"], ["spectral.exr"], [], prints=True),
        Scenario("verify", ["verify", "spectral.exr", *threads], ["spectral.exr"], [], prints=True),
        Scenario("bench", ["bench", "--quick", "--cache-only", "--only", "divide_or_zero", "--threads", "1", "--report",
                           "report.html", "-q"], [], [], {"report.html": is_page}),
    ]


def clean_run(tool, scenario, inputs, folder, with_old):
    """Outcome of a run without a fault, and the files that it left."""
    scenario.prepare(inputs, folder, with_old)
    outcome = tool.run(scenario.arguments, folder)
    if outcome.exit != 0:
        raise RuntimeError(f"{scenario.name} fails without a fault: {outcome.exit} {outcome.err}")
    return outcome, read_folder(folder)


def remove(folder):
    shutil.rmtree(folder)
