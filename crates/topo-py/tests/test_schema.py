"""The schema of scene files, as an editor reads it, takes the shipped scenes and the examples of the reference."""

import json
import re
import tomllib
from pathlib import Path

import pytest

jsonschema = pytest.importorskip("jsonschema")
ROOT = Path(__file__).parents[3]
SCHEMA = json.loads((ROOT / "docs/scene.schema.json").read_text(encoding="utf-8"))
VALIDATOR = jsonschema.Draft7Validator(SCHEMA)
BASES = {"rod": {"rod": {"knot": "3_1"}}, "nematic": {"nematic": {"field": {"vector": [0, 0, 1], "anisotropy": 1}}}}

# what a table needs besides the key of the example
NEEDED = {
    "charge.twisting": {"charge": {"twisting": {"over": 5.0}}},
    "charge.break": {"charge": {"break": {"criterion": "energy", "threshold": 1.0}}},
    "si": {"si": {"radius": 1e-3, "bending_modulus": 1e7, "viscosity": 1e4}},
    "pull": {"pull": {"grips": [{}, {}], "duration": 2.0}},
}


def merged(into, more):
    for key, value in more.items():
        both = isinstance(value, dict) and isinstance(into.get(key), dict)
        into[key] = merged(dict(into[key]), value) if both else value
    return into


def examples():
    page = (ROOT / "docs/scenes.md").read_text(encoding="utf-8")
    for battery, base in BASES.items():
        part = page.split(f"<!-- {battery} -->")[1].split(f"<!-- end of {battery} -->")[0]
        table = ""
        for line in part.splitlines():
            if line.startswith("### "):
                table = (re.findall(r"\[(.*)\]", line) or [""])[0]
            elif line.startswith("| `"):
                example = line.rstrip(" |").rsplit(" | ", 1)[1].strip("`")
                yield merged(json.loads(json.dumps(base)), NEEDED.get(table, {})), f"{table}.{example}" if table else example


def test_the_schema_is_one():
    jsonschema.Draft7Validator.check_schema(SCHEMA)


@pytest.mark.parametrize("scene", sorted((ROOT / "scenes").glob("*.toml")), ids=lambda p: p.stem)
def test_shipped_scenes_fit_the_schema(scene):
    VALIDATOR.validate(tomllib.loads(scene.read_text(encoding="utf-8")))


def test_examples_of_the_reference_fit_the_schema():
    n = 0
    for base, line in examples():
        # half of a ramp, which the reference has in a line of its own
        if re.search(r"\{ (to|over) = [\d.]+ \}", line):
            continue
        scene = merged(base, tomllib.loads(line))
        assert not list(VALIDATOR.iter_errors(scene)), line
        n += 1
    assert n > 80


@pytest.mark.parametrize("line", ["rod.twits = 1", "rod.reading = 'soft'", "rod.contact = true", "rod.slenderness = -1", "rod.twist = {from = 1, to = 2}", "accuracy.edges = 4"])
def test_what_does_not_fit_is_refused(line):
    assert not VALIDATOR.is_valid(merged({"rod": {"knot": "3_1"}}, tomllib.loads(line)))
