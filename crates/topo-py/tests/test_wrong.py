"""Wrong uses, and what each says: the culprit and the remedy."""

import pickle

import numpy as np
import pytest
import topobatteries as topo
from conftest import QUICK

CIRCLE = np.column_stack([np.cos(np.arange(60) / 60 * 2 * np.pi), np.sin(np.arange(60) / 60 * 2 * np.pi), np.zeros(60)])


def with_hole():
    points = CIRCLE.copy()
    points[7, 1] = np.nan
    return points


def changed(table, **keys):
    return {**QUICK, table: {**QUICK.get(table, {}), **keys}}


def run(scene, **options):
    return topo.run(scene, progress=False, out="never-written", **options)


def closed_file(tmp_path):
    file = open(tmp_path / "curve.csv", "w")
    file.close()
    return file


WRONG = {
    "shape": (lambda _: topo.Curve(CIRCLE.T), "points of shape (3, 60): give shape (n, 3), a vertex a row: transpose the array"),
    "NaN": (lambda _: topo.Curve(with_hole()), "points: vertex 7 is ["),
    "text": (lambda _: topo.identify([["a", "b", "c"]]), "points: could not convert string to float: 'a'; give numbers"),
    "repeated vertex": (lambda _: topo.Curve(np.r_[CIRCLE, CIRCLE[:1]]), "a closed curve must not repeat its first vertex"),
    "unknown knot": (lambda _: topo.Knot("7_8"), "no knot `7_8` in the table"),
    "closed file": (lambda p: topo.Curve.read(closed_file(p)), "this is a closed file: give its path"),
    "missing file": (lambda p: topo.run(p / "none.toml", progress=False), "none.toml"),
    "unknown key": (lambda _: run(changed("rod", slendernes=50)), "did you mean `slenderness`?"),
    "impossible value": (lambda _: run(changed("rod", slenderness=-50)), "rod.slenderness = -50"),
    "value of the wrong type": (lambda _: run(changed("rod", twist="a lot")), "rod.twist"),
    "object in a scene": (lambda _: run(changed("rod", twist=object())), "rod.twist is of type object: give a number"),
    "no battery": (lambda _: run({"charge": {}}), "no table [rod] (a knotted fibre) or [nematic] (a colloid): write one"),
    "option of the other battery": (lambda _: run({"nematic": {"q": 1}}, cuts="argmax"), "cuts = argmax"),
    "preset": (lambda _: run(QUICK, quality="best"), "best"),
    "open curve": (lambda _: topo.Rod(topo.Curve(CIRCLE, closed=False)), "a battery needs a closed curve"),
    "too few edges": (lambda _: topo.Rod(CIRCLE, edges=4), "a rod of 4 edges cannot be modelled: use at least 8 edges"),
    "cut beside the rod": (lambda _: topo.Rod(CIRCLE, edges=40).charge(duration=0.01).cut(1.5), "cut at s/L = 1.5"),
    "reading": (lambda _: topo.Rod(CIRCLE, reading="loose"), 'reading = "loose": write "shrunk", "hard", "tight" or "own-length"'),
    "share": (lambda p: topo.Rod(CIRCLE, edges=40).charge(duration=0.01).cut().discharge(until_released=0.1).time_to(99), "share = 99: a share released lies between 0 and 1"),
    "coarse grid": (lambda _: topo.Colloid(radius=20, q=1, spacing=8), "spacing"),
    "key of a colloid": (lambda _: topo.Colloid(radius=5, q=1, anchorin="strong"), "anchorin = \"strong\": there is no such key; did you mean `anchoring`?"),
    "folder without results": (lambda p: topo.load(p), "has no results (sweep.csv)"),
}



def charged():
    return topo.Rod(CIRCLE, edges=40).charge(duration=0.01)


#: Arguments of objects that cannot be: the key and the value that the error has, and a part of the remedy.
ARGUMENTS = {
    "twist": (lambda: topo.Rod(CIRCLE, twist="a lot"), "twist", '"a lot"', "write a number"),
    "slenderness": (lambda: topo.Rod(CIRCLE, slenderness="50"), "slenderness", '"50"', "numbers stand without quotes: 50"),
    "edges": (lambda: topo.Rod(CIRCLE, edges=60.0), "edges", "60.0", "write 60 without a point"),
    "tolerance": (lambda: topo.Rod(CIRCLE, tolerance=[1e-3]), "tolerance", "[0.001]", "write a number from 1e-10 to 1"),
    "reading": (lambda: topo.Rod(CIRCLE, reading="own-lenght"), "reading", '"own-lenght"', 'did you mean "own-length"?'),
    "friction": (lambda: topo.Rod(CIRCLE, friction={"ratoi": 0.1}), "friction.ratoi", "0.1", "[friction] has no such key; did you mean `ratio`?"),
    "range": (lambda: topo.Rod(CIRCLE, friction={"range": "contacts"}), "friction.range", '"contacts"', 'did you mean "contact"?'),
    "no friction": (lambda: topo.Rod(CIRCLE, friction="none"), "friction", '"none"', "a table such as { ratio ="),
    "contact": (lambda: topo.Rod(CIRCLE, contact="stiff"), "contact.stiffness", '"stiff"', "write a number from 1e-6 to 1e9"),
    "out of range": (lambda: topo.Rod(CIRCLE, stretch_ratio=-5), "stretch_ratio", "-5", "expected"),
    "Poisson's ratio": (lambda: topo.Rod(CIRCLE, poisson_ratio="0.3"), "poisson_ratio", "'0.3'", "give a number above -1 and at most 0.5"),
    "duration": (lambda: topo.Rod(CIRCLE, edges=40).charge(duration="long"), "duration", '"long"', "write a number above 0"),
    "share": (lambda: charged().cut().discharge(until_released="all"), "until_released", '"all"', "write a number from 1e-6 to 0.999999999"),
    "radius": (lambda: topo.Colloid(radius="big"), "radius", '"big"', "write a number"),
    "charge": (lambda: topo.Colloid(q="one"), "q", "one", "give a whole number from 0 to 10000"),
    "anchoring": (lambda: topo.Colloid(radius=5, anchoring="strog"), "anchoring", '"strog"', 'did you mean "strong"?'),
    "material": (lambda: topo.Colloid(radius=5, material={"A": 1.0}), "material.A", "1.0", "did you mean `a`?"),
    "precision": (lambda: topo.Colloid(radius=5, precision="singles"), "precision", '"singles"', 'did you mean "single"?'),
    "tilts": (lambda: topo.Colloid(radius=5, spacing=1.0).charge(tilts=0.1), "tilts", "0.1", "a list stands in brackets: [0.1]"),
}


@pytest.mark.parametrize("use", ARGUMENTS)
def test_wrong_arguments_of_objects_name_key_value_and_remedy(use):
    do, key, value, remedy = ARGUMENTS[use]
    with pytest.raises(topo.TopoError) as caught:
        do()
    error = caught.value
    print(f"{use}: {error}")
    assert (error.key, error.value) == (key, value) and remedy in error.remedy
    assert str(error) == f"{key} = {value}: {error.remedy}" or "expected" in str(error)


@pytest.mark.parametrize("use", WRONG)
def test_wrong_uses_say_what_would_be_right(use, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    do, words = WRONG[use]
    with pytest.raises((ValueError, TypeError, OSError)) as caught:
        do(tmp_path)
    print(f"{use}: {type(caught.value).__name__}: {caught.value}")
    assert words in str(caught.value)
    assert not (tmp_path / "never-written").exists()


def test_scene_errors_have_file_line_key_value_and_remedy(tmp_path):
    file = tmp_path / "s.toml"
    file.write_text("[rod]\nknot = '3_1'\nslenderness = -5\n", encoding="utf-8")
    with pytest.raises(topo.SceneError) as caught:
        topo.run(file, progress=False)
    error = caught.value
    assert (error.file, error.line, error.key, error.value) == (str(file), 3, "rod.slenderness", "-5")
    assert error.remedy
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again), again.key) == (topo.SceneError, str(error), error.key)
    file.write_text("[rod]\nknot = '3_1'\nlenght = 5\n", encoding="utf-8")
    with pytest.raises(topo.SceneError) as caught:
        topo.run(file, progress=False)
    error = caught.value
    assert (error.line, error.key, error.value) == (3, "rod.lenght", "5") and error.remedy.startswith("[rod] has no such key")


def test_results_name_cases_that_are_there(quick, small):
    with pytest.raises(topo.TopoError, match="did you mean 3_1_untwisted"):
        quick.series("3_1_untwisted")
    with pytest.raises(topo.TopoError, match="there are 2 cases"):
        small.series()
    with pytest.raises(topo.TopoError, match="there are 2 cases, counted from 0"):
        small.series(7)
    with pytest.raises(topo.TopoError, match="give one of released, times, energy"):
        quick.plot("time")
