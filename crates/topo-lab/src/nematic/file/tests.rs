use super::*;
use topo_nematic::anchoring::PlateDirector;
use topo_nematic::{Anchoring, Boundary, SurfacePattern};

fn parse(text: &str) -> Result<NematicScene, LabError> {
    NematicScene::parse(text, Path::new("scene.toml"))
}

#[test]
fn a_scene_says_what_is_modelled() {
    let scene =
        parse("[nematic]\nradius = 15\nq = [2, 5]\n[material]\nsurface_order = 0.6").unwrap();
    assert_eq!(scene.charges, [2, 5]);
    assert!(scene.flow.is_none() && scene.nematic.material.surface_order == Some(0.6));
    let cases = scene.cases();
    assert_eq!(cases.len(), 2);
    assert_eq!(cases[1].nematic.pattern, SurfacePattern::Winding(5));
    let flowing = parse("[nematic]\nradius = 15\nq = [2, 5]\n[flow]\nq = 5").unwrap();
    let with = |scene: &NematicScene| {
        let cases = scene.cases();
        cases
            .iter()
            .map(|c| (c.q, c.flow.is_some()))
            .collect::<Vec<_>>()
    };
    assert_eq!(with(&flowing), [(2, false), (5, false), (5, true)]);
    let all = parse("[nematic]\nq = { from = 1, to = 3, n = 3 }\n[flow]\nboundary_residual = 0.1")
        .unwrap();
    assert_eq!(with(&all), [(1, true), (2, true), (3, true)]);
    assert_eq!(all.flow.unwrap().boundary_residual, 0.1);
    let plain = parse("[nematic]\npattern = \"homeotropic\"").unwrap();
    assert_eq!(with(&plain), [(0, false)]);
}

#[test]
fn bad_scenes_are_refused_with_key_value_and_remedy() {
    for (text, words) in [
        (
            "[nematic]\nraduis = 2",
            vec!["scene.toml", "line 2", "raduis", "radius"],
        ),
        (
            "[nematic]\nq = 0",
            vec!["nematic.q", "0", "whole numbers from 1"],
        ),
        ("[nematic]\nq = -3", vec!["nematic.q", "-3"]),
        ("[nematic]\nq = 2.5", vec!["nematic.q", "2.5"]),
        ("[nematic]\nq = []", vec!["nematic.q"]),
        (
            "[nematic]\nq = 1\npattern = \"homeotropic\"",
            vec!["nematic.pattern", "either"],
        ),
        (
            "[nematic]\nq = 1\n[flow]\nevery = 2",
            vec!["line 4", "every", "boundary_residual"],
        ),
        ("[nematic]\nq = 1\n[flow]\nq = 0", vec!["flow.q"]),
        (
            "[nematic]\nq = 1\n[accuracy]\ntolerance = -1",
            vec!["tolerance", "-1"],
        ),
        (
            "[nematic]\nq = \"two\"",
            vec!["scene.toml, line 2: nematic.q", "a list of numbers"],
        ),
    ] {
        let message = parse(text).unwrap_err().to_string();
        for word in words {
            assert!(
                message.contains(word),
                "{text:?} gives {message:?} without {word:?}"
            );
        }
    }
}

const COLLOID: &str = "[nematic]\nradius = 15\n";

#[test]
fn cases_are_the_product_of_all_lists_and_ranges() {
    let text = "[nematic]\nradius = [10, 15]\nspacing = { from = 1.0, to = 1.5, n = 2 }\nq = [3, 2]\nanchoring = [\"strong\", { weak = 1.0 }]\nboundary = [\"node-mask\",\n \"cut-link\"]\nplates.director = { planar = [0.0, 0.5] }\nfield = { vector = [0, 0, 0.1], anisotropy = [1, -1] }\n[nematic.material]\nviscosity = [1.0, 2.0]\nsecond_elastic_constant = { from = 0.0, to = 0.5, n = 2 }\n[flow]\n";
    let scene = parse(text).unwrap();
    let cases = scene.cases();
    assert_eq!(cases.len(), 1 << 9);
    assert!(cases.iter().all(|c| c.flow.is_some()));
    let anisotropies: Vec<f64> = cases[..2]
        .iter()
        .map(|c| c.nematic.field.unwrap().anisotropy)
        .collect();
    assert_eq!(anisotropies, [1.0, -1.0]);
    assert_eq!((cases[0].q, cases[511].q), (3, 2));
    assert_eq!(
        (cases[0].nematic.radius, cases[128].nematic.radius),
        (10.0, 15.0)
    );
    assert_eq!(
        (cases[0].nematic.spacing, cases[64].nematic.spacing),
        (1.0, 1.5)
    );
    assert_eq!(cases[32].nematic.anchoring, Anchoring::Weak(1.0));
    assert_eq!(cases[16].nematic.boundary, Boundary::CutLink);
    assert_eq!(cases[8].nematic.plates.director, PlateDirector::Planar(0.5));
    assert_eq!(cases[4].nematic.material.second_elastic_constant, Some(0.5));
    assert_eq!(cases[2].nematic.material.viscosity, 2.0);
    for (k, case) in cases.iter().enumerate() {
        assert!(!cases[..k].contains(case));
    }
    assert_eq!(parse(&scene.text()).unwrap(), scene);
    // patterns of one scene, and flow after without
    let text = "[nematic]\nradius = 15\npattern = [\"homeotropic\", { planar = { axis = [0, 0, 1] } }, { charge = 4 }]\n";
    let patterns = parse(text).unwrap();
    let windings: Vec<u32> = patterns.cases().iter().map(|c| c.q).collect();
    assert_eq!(windings, [0, 0, 4]);
    assert_eq!(parse(&patterns.text()).unwrap(), patterns);
    let flowing = parse("[nematic]\nradius = [10, 15]\nq = [1, 2]\n[flow]\nq = 2").unwrap();
    let seen: Vec<_> = flowing
        .cases()
        .iter()
        .map(|c| (c.q, c.nematic.radius, c.flow.is_some()))
        .collect();
    assert_eq!(
        seen,
        [
            (1, 10.0, false),
            (1, 15.0, false),
            (2, 10.0, false),
            (2, 10.0, true),
            (2, 15.0, false),
            (2, 15.0, true)
        ]
    );
}

#[test]
fn the_json_of_a_case_is_what_it_was() {
    let scene = parse("[nematic]\nradius = [15, 16]\nq = 2").unwrap();
    let json = serde_json::to_string(&scene.cases()[0]).unwrap();
    let before = "{\"q\":2,\"nematic\":{\"radius\":15.0,\"spacing\":1.5,\"cell\":[5.714285714285714,5.714285714285714,4.285714285714286],\"particle\":true,\"pattern\":{\"charge\":2},\"anchoring\":\"strong\",\"boundary\":\"cut-link\",\"plates\":";
    assert!(
        json.starts_with(before) && json.ends_with(",\"flow\":null}"),
        "{json}"
    );
    let plain = serde_json::to_string(&parse(COLLOID).unwrap()).unwrap();
    assert!(
        !plain.contains("axes") && !plain.contains("fitted"),
        "{plain}"
    );
}

#[test]
fn a_goal_fits_the_grid_of_every_case() {
    let scene = parse("accuracy = 0.1\n[nematic]\nradius = [15, 17]\nq = 2").unwrap();
    assert_eq!(parse(&scene.text()).unwrap(), scene);
    let (chosen, choice) = scene.with_chosen_settings(1).unwrap();
    let spacing = choice.unwrap().point.resolution;
    for (case, radius) in chosen.cases().iter().zip([15.0, 17.0]) {
        let single = parse(&format!(
            "accuracy = 0.1\n[nematic]\nradius = {radius}\nq = 2"
        ))
        .unwrap();
        let (single, _) = single.with_chosen_settings(1).unwrap();
        assert_eq!(*case, single.cases()[0]);
        assert!(case.nematic.spacing <= spacing * (1.0 + 1e-9));
    }
    let budget = parse("budget = \"1h\"\n[nematic]\nradius = 15\nq = 2").unwrap();
    assert_eq!(parse(&budget.text()).unwrap(), budget);
}

#[test]
fn a_cell_without_a_particle_has_no_winding() {
    let text = "[nematic]\nradius = 15\nparticle = false\n[switch]\nto = \"keep\"\n";
    let scene = parse(text).unwrap();
    assert_eq!(scene.cases()[0].q, 0);
    assert_eq!(parse(&scene.text()).unwrap(), scene);
}

/// Scenes of the colloid with these lines are refused with these words: file, line, key, value, remedy.
fn assert_refused(scenes: &[(&str, [&str; 2])]) {
    for (more, words) in scenes {
        let text = format!("{COLLOID}{more}\n");
        let message = parse(&text).expect_err(more).to_string();
        assert!(message.contains("scene.toml"), "{more:?} gives {message:?}");
        assert_words(&text, &message, words);
    }
}

fn assert_words(text: &str, message: &str, words: &[&str]) {
    for word in words {
        assert!(
            message.contains(word),
            "{text:?} gives {message:?} without {word:?}"
        );
    }
}

#[test]
fn flow_of_what_is_not_there_is_refused() {
    assert_refused(&[
        (
            "q = 2\n[flow]\nq = 5",
            ["line 5: flow.q = 5", "nematic.q has no such winding"],
        ),
        (
            "pattern = \"homeotropic\"\n[flow]\nq = 5",
            ["line 5: flow.q = 5", "there are none"],
        ),
        (
            "q = [2, 3]\n[flow]\nq = []",
            ["line 5: flow.q = []", "leave the key out"],
        ),
    ]);
}

#[test]
fn what_is_there_twice_is_refused() {
    assert_refused(&[
        (
            "q = [1, 2, 1.0]",
            ["line 3: nematic.q = 1 is", "there twice"],
        ),
        (
            "q = [1, 2]\n[flow]\nq = [2, 2]",
            ["line 5: flow.q = 2 is", "there twice"],
        ),
        (
            "pattern = [\"homeotropic\", { charge = 2 }, \"homeotropic\"]",
            ["line 3: nematic.pattern = \"homeotropic\"", "there twice"],
        ),
        (
            "anchoring.weak = { from = 1, to = 1, n = 2 }",
            ["line 3: nematic.anchoring.weak = 1 is", "there twice"],
        ),
        (
            "[charge]\nseeds = [0.0, -0.0]",
            ["line 4: charge.seeds = 0 is", "there twice"],
        ),
    ]);
}

#[test]
fn what_needs_a_particle_is_refused_without_one() {
    assert_refused(&[
        (
            "particle = false",
            ["line 3: nematic.particle = false", "to = \"keep\""],
        ),
        (
            "particle = false\n[switch]\nto = { free = \"cut-cell\" }",
            ["line 5: switch.to = { free", "to = \"keep\""],
        ),
        (
            "particle = false\nq = 2\n[switch]\nto = \"keep\"",
            ["line 4: nematic.q = 2", "no particle"],
        ),
        (
            "particle = false\nanchoring = \"free\"\n[switch]\nto = \"keep\"",
            ["line 4: nematic.anchoring", "no particle"],
        ),
    ]);
}

#[test]
fn settings_of_a_run_out_of_range_are_refused_before_the_charge() {
    assert_refused(&[
        (
            "[discharge]\nuntil_released = 1.5",
            ["line 4: discharge.until_released = 1.5", "<= 0.999"],
        ),
        (
            "[discharge]\nlongest = 0",
            ["line 4: discharge.longest = 0", "above zero"],
        ),
        (
            "[discharge]\nfirst_output = -1",
            ["line 4: discharge.first_output = -1", "above zero"],
        ),
        (
            "[discharge]\noutputs_per_decade = 1e9",
            ["line 4: discharge.outputs_per_decade", "<= 1000000"],
        ),
        (
            "[discharge]\nring_threshold = nan",
            ["line 4: discharge.ring_threshold = NaN", "finite"],
        ),
        (
            "[switch]\nramp = -1",
            ["line 4: switch.ramp = -1", "above zero"],
        ),
        (
            "[switch]\nto = { pattern = { pattern = { planar = { axis = [0, 0, 0] } }, anchoring = \"strong\" } }",
            ["line 4: switch.to.pattern.pattern.planar.axis", "expected"],
        ),
        (
            "[switch]\nto = { pattern = { pattern = \"homeotropic\", anchoring = { weak = -1 } } }",
            [
                "line 4: switch.to.pattern.anchoring.weak = -1",
                "zero or above",
            ],
        ),
        (
            "[charge]\nseed_azimuth = inf",
            ["line 4: charge.seed_azimuth = inf", "finite"],
        ),
        (
            "[charge]\norder_tolerance = 0",
            ["line 4: charge.order_tolerance = 0", "above zero"],
        ),
        (
            "[charge]\nmax_steps = 0",
            ["line 4: charge.max_steps = 0", "1 <="],
        ),
    ]);
}

#[test]
fn materials_flows_and_grids_out_of_range_are_refused() {
    assert_refused(&[
        (
            "[material]\nelastic_constant = -1",
            ["line 4: material.elastic_constant = -1", "above zero"],
        ),
        (
            "[nematic.material]\nrotational_mobility = [1, 0]",
            ["line 4: material.rotational_mobility = 0", "above zero"],
        ),
        (
            "[material]\nb = 0\na = 1",
            ["line 4: material.b = 0", "nematic phase"],
        ),
        (
            "[flow]\nboundary_residual = 0",
            ["line 4: flow.boundary_residual = 0", "above zero"],
        ),
        (
            "sides = { walled = {} }\n[flow]\nsolver = \"spectral\"",
            ["line 5: flow.solver = \"spectral\"", "periodic sides"],
        ),
        (
            "[flow]\ndrive.mean_velocity = [1, 0, 0]",
            ["line 4: flow.drive", "body_force"],
        ),
        (
            "[flow]\nmemory_limit = 10",
            ["line 4: flow.memory_limit = 10", "coarser grid"],
        ),
        (
            "spacing = [1.0, 30]",
            ["line 3: nematic.spacing = 30", "too coarse"],
        ),
        (
            "cell = [2, 2, 2]",
            ["line 2: nematic.radius = 15", "larger cell"],
        ),
        (
            "pattern = { charge = 20000 }",
            ["line 3: nematic.pattern.charge = 20000", "to 10000"],
        ),
        (
            "periodic = true\nsides = { walled = {} }",
            ["line 3: nematic.periodic = true", "walled sides"],
        ),
    ]);
}

#[test]
fn what_changes_nothing_is_refused() {
    assert_refused(&[
        (
            "cells = [60, 60, 50]\ncell = [6, 6, 5]",
            ["line 4: nematic.cell = [6, 6, 5]", "keep one"],
        ),
        (
            "q = 3\nanchoring = \"free\"",
            ["line 3: nematic.q = 3", "anchoring is free"],
        ),
        (
            "[material]\nviscosity = 2",
            ["line 4: material.viscosity = 2", "no flow"],
        ),
        (
            "q = [1, 2]\n[material]\nviscosity = [1, 2]\n[flow]\nq = 1",
            ["line 5: material.viscosity = [1, 2]", "leave flow.q out"],
        ),
        (
            "[flow]\nsolver_tolerance = 1e-6",
            ["line 4: flow.solver_tolerance = 1e-6", "direct"],
        ),
        (
            "[switch]\nto = \"keep\"\nramp = 1",
            ["line 5: switch.ramp = 1", "kept"],
        ),
        (
            "[charge]\nseeds = [0]\nseed_azimuth = 1",
            ["line 5: charge.seed_azimuth = 1", "no start field"],
        ),
        (
            "[accuracy]\nthreads = \"all\"",
            ["line 4: accuracy.threads = \"all\"", "--jobs"],
        ),
        (
            "[discharge.flow]\n",
            ["line 3: discharge.flow = a table", "did you mean `flow`"],
        ),
    ]);
}

#[test]
fn nothing_absurd_is_begun() {
    assert_refused(&[
        (
            "q = { from = 1, to = 100, n = 1000000000000 }",
            ["line 3: nematic.q.n = 1000000000000", "1 to 100000"],
        ),
        (
            "q = 20000",
            ["line 3: nematic.q = 20000", "from 1 to 10000"],
        ),
        (
            "cells = [1200, 1200, 1200]",
            ["line 3: nematic.cells = [1200, 1200, 1200]", "memory_limit"],
        ),
        (
            "cells = [100000, 100000, 100000]",
            ["line 3: nematic.cells", "too large"],
        ),
        (
            "cells = [60, 60, 50]\n[accuracy]\nmemory_limit = 10",
            ["line 5: accuracy.memory_limit = 10", "60"],
        ),
        (
            "q = { from = 1, to = 1000, n = 1000 }\nanchoring.weak = { from = 1, to = 2, n = 1000 }",
            [
                "= 1000000 cases",
                "nematic.q (1000), nematic.anchoring.weak (1000)",
            ],
        ),
    ]);
}

#[test]
fn keys_above_and_across_tables_are_looked_at() {
    for (text, words) in [
        (
            "knots = \"mine\"\n[nematic]\nq = 1",
            ["line 1: knots = \"mine\"", "no knots"],
        ),
        (
            "accuracy = 0.1\n[nematic]\nspacing = 1.0",
            ["line 3: nematic.spacing = 1.0", "pick the spacing"],
        ),
        (
            "[nematic]\nmaterial = { a = -0.1 }\n[material]\nb = -2",
            ["line 2: nematic.material", "keep one"],
        ),
        (
            "accuracy = 0.1\n[nematic]\nq = 1\n[flow]\nboundary_residual = 0",
            ["line 5: flow.boundary_residual = 0", "above zero"],
        ),
    ] {
        let message = parse(text).expect_err(text).to_string();
        assert_words(text, &message, &words);
    }
}
