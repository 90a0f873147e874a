use super::*;
use topo_knots::KnotTable;
use topo_rod::FrictionRange;

fn parse(text: &str) -> Result<ElasticScene, LabError> {
    ElasticScene::parse(text, Path::new("scene.toml"))
}

#[test]
fn a_scene_says_what_is_modelled() {
    let scene = parse("[rod]\nknot = \"7_4\"\ntwist = -2.0\n[rod.contact]\n[rod.friction]\nratio = 0.2\n[discharge]\ncuts = \"all:8\"\n[accuracy]\npreset = \"standard\"\nedges = 120").unwrap();
    assert_eq!(scene.rod.friction.unwrap().ratio, 0.2);
    assert_eq!(scene.rod.contact.unwrap().stiffness, 20.0);
    assert_eq!(
        (scene.cuts, scene.rod.n_edges, scene.twists.as_slice()),
        (Cuts::All(8), 120, &[-2.0][..])
    );
    let bare = parse("[rod]\nknot = [\"3_1\", \"4_1\"]").unwrap();
    assert!(bare.rod.friction.is_none() && bare.rod.contact.is_none() && bare.twists.is_empty());
    let cases = bare.cases(&topo_knots::KnotTable::builtin()).unwrap();
    assert_eq!(
        cases.iter().map(|c| bare.case_name(c)).collect::<Vec<_>>(),
        [
            "3_1_untwisted_shrunk_n200_no-contact_no-friction",
            "4_1_untwisted_shrunk_n200_no-contact_no-friction"
        ]
    );
}

#[test]
fn bad_scenes_are_refused_with_key_value_and_remedy() {
    for (text, words) in [
        (
            "[rod]\nknot = \"3_1\"\ntwits = 2",
            vec!["scene.toml", "twits", "twist"],
        ),
        (
            "[rod]\nknot = \"3_1\"\ntwist = nan",
            vec!["rod.twist", "NaN", "finite"],
        ),
        (
            "[rod]\nknot = \"3_1\"\nslenderness = -50",
            vec!["slenderness", "-50"],
        ),
        (
            "[rod]\nknot = \"3_1\"\n[accuracy]\nedges = 4",
            vec!["accuracy.edges = 4", "8 edges"],
        ),
        (
            "[rod]\nknot = \"3_1\"\n[rod.friction]\nratio = -1",
            vec!["friction.ratio", "-1"],
        ),
        ("[rod]\nknot = 3", vec!["scene.toml", "knot"]),
        (
            "[rod]\nknot = \"3_1\"\n[discharge]\ncuts = \"all:0\"",
            vec!["all:0", "near-ties"],
        ),
        (
            "[rod]\nknot = \"3_1\"\npoisson_ratio = 0.9",
            vec!["rod.poisson_ratio", "0.9"],
        ),
        ("[rod]\nknot = []", vec!["rod.knot"]),
        ("knot = 1", vec!["scene.toml"]),
    ] {
        let message = parse(text).unwrap_err().to_string();
        for word in words {
            assert!(
                message.contains(word),
                "{text:?} gives {message:?} without {word:?}"
            );
        }
    }
    let unknown = parse("[rod]\nknot = \"3_7\"")
        .unwrap()
        .cases(&topo_knots::KnotTable::builtin())
        .unwrap_err()
        .to_string();
    assert!(
        unknown.contains("3_7") && unknown.contains("3_1"),
        "{unknown}"
    );
}

const KNOT: &str = "[rod]\nknot = \"3_1\"\n";

#[test]
fn cases_are_the_product_of_all_lists_and_ranges() {
    let text = "[rod]\nknot = [\"3_1\", \"4_1\"]\ntwist = [0.0, 1.0]\nslenderness = { from = 40, to = 60, n = 3 }\nreading = [\"hard\", \"shrunk\"]\nseed = [1, 9007199254740993]\n[rod.contact]\nstiffness = [5,\n 20.0]\n[rod.friction]\nrange = [\"contact\", { times-contact = 1.2 }]\n[accuracy]\nedges = [60, 80]";
    let scene = parse(text).unwrap();
    let table = KnotTable::builtin();
    let cases = scene.cases(&table).unwrap();
    assert_eq!(cases.len(), 2 * 2 * 3 * 2 * 2 * 2 * 2 * 2);
    // the last key runs fastest, the first slowest
    assert_eq!((cases[0].rod.n_edges, cases[1].rod.n_edges), (60, 80));
    assert_eq!((cases[0].seed, cases[2].seed), (1, 9_007_199_254_740_993));
    assert_eq!(
        cases[4].rod.friction.unwrap().range,
        FrictionRange::TimesContact(1.2)
    );
    assert_eq!(cases[8].rod.contact.unwrap().stiffness, 20.0);
    assert_eq!(
        (cases[0].rod.reading, cases[16].rod.reading),
        (Reading::Hard, Reading::Shrunk)
    );
    let slenderness: Vec<f64> = cases
        .iter()
        .step_by(32)
        .map(|c| c.rod.slenderness)
        .collect();
    assert_eq!(slenderness[..4], [40.0, 50.0, 60.0, 40.0]);
    assert_eq!(
        (cases[95].rod.twist, cases[96].rod.twist),
        (Some(0.0), Some(1.0))
    );
    assert_eq!(
        (cases[191].knot.as_str(), cases[192].knot.as_str()),
        ("3_1", "4_1")
    );
    // no two are alike, and no two states but for the edges
    let states: Vec<String> = cases.iter().map(ElasticCase::state).collect();
    for (k, case) in cases.iter().enumerate() {
        assert!(!cases[..k].contains(case));
        let same = states.iter().filter(|state| **state == states[k]).count();
        assert_eq!(same, 2, "{}", states[k]);
    }
    assert_eq!(parse(&scene.text()).unwrap(), scene);
    // one value is no axis
    let one = parse(&format!("{KNOT}slenderness = [40]\nimperfection = 0.01")).unwrap();
    let case = one.cases(&table).unwrap().remove(0);
    assert!(one.axes.is_empty() && case.rod.slenderness == 40.0 && case.imperfection == 0.01);
}

#[test]
fn poisson_ratios_of_a_range_are_those_of_single_scenes() {
    let range = parse(&format!(
        "{KNOT}twist = 1.0\npoisson_ratio = {{ from = 0.0, to = 0.5, n = 6 }}"
    ))
    .unwrap();
    let table = KnotTable::builtin();
    for (k, case) in range.cases(&table).unwrap().iter().enumerate() {
        let nu = 0.5 * k as f64 / 5.0;
        let single = parse(&format!("{KNOT}twist = 1.0\npoisson_ratio = {nu:?}")).unwrap();
        assert_eq!(*case, single.cases(&table).unwrap()[0]);
    }
}

#[test]
fn what_varies_lies_in_the_case_and_its_json_is_what_it_was() {
    let scene = parse(&format!(
        "{KNOT}twist = 1.0\nseed = [1, 2]\nimperfection = [0.0, 0.1]"
    ))
    .unwrap();
    let cases = scene.cases(&KnotTable::builtin()).unwrap();
    let varied: Vec<(f64, u64)> = cases.iter().map(|c| (c.imperfection, c.seed)).collect();
    assert_eq!(varied, [(0.0, 1), (0.0, 2), (0.1, 1), (0.1, 2)]);
    let json = serde_json::to_string(&cases[0]).unwrap();
    assert_eq!(
        json,
        r#"{"knot":"3_1","rod":{"slenderness":50.0,"reading":"shrunk","n_edges":200,"twist_ratio":0.7692307692307692,"stretch_ratio":5.0,"twist":1.0,"contact":null,"friction":null}}"#
    );
    let plain = serde_json::to_string(&parse(KNOT).unwrap()).unwrap();
    assert!(
        ["axes", "own_knots", "break", "\"si\""]
            .iter()
            .all(|absent| !plain.contains(absent)),
        "{plain}"
    );
}

#[test]
fn cuts_may_be_given() {
    for (text, at) in [("0.25", vec![0.25]), ("[0.5, 0]", vec![0.5, 0.0])] {
        let scene = parse(&format!("{KNOT}[discharge]\ncuts = {text}")).unwrap();
        assert_eq!(scene.cuts, Cuts::At(at));
        assert_eq!(parse(&scene.text()).unwrap(), scene);
    }
    let scene = parse(&format!("{KNOT}[accuracy]\nedges = [50, 100]")).unwrap();
    assert!(scene.clone().with_cuts(Cuts::All(50)).is_ok());
    assert!(
        scene
            .with_cuts(Cuts::All(51))
            .unwrap_err()
            .contains("50 edges")
    );
}

#[test]
fn cuts_may_be_those_of_a_criterion() {
    use topo_rod::Criterion;
    for (text, cuts) in [
        ("energy", Cuts::default()),
        ("curvature", Cuts::Largest(Criterion::Curvature)),
        ("von-mises", Cuts::Largest(Criterion::VonMises)),
        ("near-ties:tension", Cuts::NearTies(Criterion::Tension)),
        ("criteria", Cuts::Criteria),
    ] {
        let scene = parse(&format!("{KNOT}[discharge]\ncuts = \"{text}\"")).unwrap();
        assert_eq!(scene.cuts, cuts);
        assert_eq!(parse(&scene.text()).unwrap(), scene);
    }
}

#[test]
fn a_fibre_may_break_by_itself_and_say_what_it_is_made_of() {
    let breaks = "[charge.break]\ncriterion = \"von-mises\"\nthreshold = 0.8\n";
    let scene = parse(&format!("{KNOT}{breaks}")).unwrap();
    assert_eq!(scene.charge.breaking.unwrap().threshold, 0.8);
    assert!(!scene.text().contains("cuts"), "{}", scene.text());
    assert_eq!(parse(&scene.text()).unwrap(), scene);
    let refused = scene.with_cuts(Cuts::All(3)).unwrap_err();
    assert!(refused.contains("[charge.break]"), "{refused}");
    let silicone = "[si]\nradius = 1e-3\nbending_modulus = 1e7\nviscosity = 1e4\n";
    let scene = parse(&format!("{KNOT}{silicone}")).unwrap();
    assert_eq!(scene.si.unwrap().density, None);
    assert_eq!(parse(&scene.text()).unwrap(), scene);
    // units change no case
    let table = KnotTable::builtin();
    let plain = parse(KNOT).unwrap();
    let case = &plain.cases(&table).unwrap()[0];
    assert_eq!(scene.case_name(case), plain.case_name(case));
    assert_refused(&[
        (
            "[charge.break]\ncriterion = \"tension\"\nthreshold = 1\n[discharge]\ncuts = \"near-ties\"",
            ["line 7: discharge.cuts = \"near-ties\"", "leave out one"],
        ),
        (
            "[charge.break]\ncriterion = \"tension\"\nthreshold = -1",
            ["line 5: charge.break.threshold = -1", "above zero"],
        ),
        (
            "[charge.break]\ncriterion = \"stress\"\nthreshold = 1",
            [
                "line 4: charge.break.criterion = \"stress\"",
                "\"von-mises\"",
            ],
        ),
        (
            "[charge.break]\ncriterion = \"tension\"",
            ["charge.break", "threshold"],
        ),
        (
            "[si]\nradius = 0\nbending_modulus = 1e7\nviscosity = 1e4",
            ["line 4: si.radius = 0", "above zero"],
        ),
        (
            "[si]\nradius = 1e-3\nbending_modulus = 1e7\nviscosity = inf",
            ["line 6: si.viscosity = inf", "above zero"],
        ),
        (
            "[si]\nradius = 1e-3\nbending_modulus = 1e7\nviscosity = 1e4\ndensity = -1",
            ["line 7: si.density = -1", "above zero"],
        ),
        (
            "[si]\nradius = 1e-3\nbending_modulus = 1e7",
            ["si", "viscosity"],
        ),
        (
            "[discharge]\ncuts = \"stress\"",
            ["line 4: discharge.cuts = \"stress\"", "\"von-mises\""],
        ),
    ]);
}

#[test]
fn a_scene_names_its_folder_and_its_knots() {
    let text = format!("knots = \"own\"\n{KNOT}");
    let scene = ElasticScene::parse(&text, Path::new("some/where/my scene.toml")).unwrap();
    assert_eq!(scene.folder, "my-scene");
    let own = scene.own_knots.clone().unwrap();
    assert_eq!(own.path(), Path::new("some/where/own"));
    assert!(scene.knot_table().unwrap_err().to_string().contains("own"));
    let again = ElasticScene::parse(&scene.text(), Path::new("some/where/my scene.toml"));
    assert_eq!(again.unwrap(), scene);
    let folder = tempfile::tempdir().unwrap();
    let mine = "name = \"own_knot\"\naliases = []\ncrossing_number = 3\nchirality = \"chiral\"\nbraid = [1, 1, 1]\n[invariants]\nalexander = [1, -1, 1]\ndeterminant = 3\nsignature = -2\njones = { lowest = 1, coefficients = [1, 0, 1, -1] }\n";
    std::fs::write(folder.path().join("own_knot.toml"), mine).unwrap();
    let built_in = parse(KNOT).unwrap().knot_table().unwrap();
    let elsewhere = ElasticScene {
        own_knots: Some(OwnKnots::at(folder.path())),
        ..scene
    };
    let table = elsewhere.knot_table().unwrap();
    assert!(table.get("own_knot").is_ok() && built_in.get("own_knot").is_err());
    assert!(ElasticScene::parse(KNOT, Path::new("figures.toml")).is_err());
}

/// Scenes of the knot with these lines are refused with these words: file, line, key, value, remedy.
fn assert_refused(scenes: &[(&str, [&str; 2])]) {
    for (more, words) in scenes {
        let text = format!("{KNOT}{more}\n");
        let message = parse(&text).expect_err(more).to_string();
        assert!(message.contains("scene.toml"), "{more:?} gives {message:?}");
        for word in words {
            assert!(
                message.contains(word),
                "{more:?} gives {message:?} without {word:?}"
            );
        }
    }
}

#[test]
fn what_is_there_twice_is_refused() {
    assert_refused(&[
        (
            "twist = [0.0, 1.0, -0.0]",
            ["line 3: rod.twist = 0 is", "there twice"],
        ),
        (
            "twist = { from = 1, to = 1, n = 3 }",
            ["line 3: rod.twist = 1 is", "coincide"],
        ),
        (
            "slenderness = [50, 40,\n 50.0]",
            ["line 3: rod.slenderness = 50 is", "there twice"],
        ),
        (
            "reading = [\"hard\", \"tight\", \"hard\"]",
            ["line 3: rod.reading = \"hard\"", "there twice"],
        ),
        (
            "[accuracy]\nedges = [50, 50]",
            ["line 4: accuracy.edges = 50", "there twice"],
        ),
        (
            "[discharge]\ncuts = [0.5, 0.5]",
            ["cuts", "0.5 is there twice"],
        ),
    ]);
}

#[test]
fn what_is_no_number_list_or_range_is_refused() {
    assert_refused(&[
        (
            "twist = { from = 1, to = 2, n = 3, by = 1 }",
            ["line 3: rod.twist = { from", "{ from = 1, to = 2, n = 3 }"],
        ),
        (
            "twist = { from = 1, to = 2, n = 0 }",
            ["line 3: rod.twist.n = 0", "1 to 100000"],
        ),
        (
            "twist = []",
            ["line 3: rod.twist = []", "leave the key out"],
        ),
        (
            "slenderness = [50, \"a\"]",
            ["line 3: rod.slenderness = \"a\"", "write a number"],
        ),
        (
            "seed = [1, 1.5]",
            ["line 3: rod.seed = 1.5", "a whole number"],
        ),
        (
            "seed = { from = 1, to = 2, n = 3 }",
            ["line 3: rod.seed = 1.5", "whole numbers"],
        ),
        (
            "reading = []",
            ["line 3: rod.reading = []", "leave the key out"],
        ),
        (
            "reading = [\"hard\", \"soft\"]",
            ["line 3: rod.reading = \"soft\"", "\"own-length\""],
        ),
        (
            "slenderness = [50,\n 40]\nreading = \"soft\"",
            ["line 5: rod.reading = \"soft\"", "\"own-length\""],
        ),
    ]);
}

#[test]
fn values_out_of_range_are_refused() {
    assert_refused(&[
        (
            "slenderness = [50, -1]",
            ["line 3: rod.slenderness = -1", "above zero"],
        ),
        (
            "poisson_ratio = [0.3, 0.9]\ntwist = 1",
            ["line 3: rod.poisson_ratio = 0.9", "up to 0.5"],
        ),
        (
            "imperfection = [0.1, 2.0]",
            ["line 3: rod.imperfection = 2", "0 to 0.5"],
        ),
        (
            "[rod.friction]\nratio = [0.1, -1]",
            ["line 4: rod.friction.ratio = -1", "0 <="],
        ),
        (
            "[discharge]\n\nuntil_released = 1.5",
            ["line 5: discharge.until_released = 1.5", "<= 0.999"],
        ),
        (
            "[discharge]\nlongest = -1",
            ["line 4: discharge.longest = -1", "above zero"],
        ),
        (
            "[charge]\nduration = 0",
            ["line 4: charge.duration = 0", "above zero"],
        ),
        (
            "[accuracy]\nreuse = 0",
            ["line 4: accuracy.reuse = 0", "1 <="],
        ),
        (
            "[accuracy]\nedges = [100, 4]",
            ["line 4: accuracy.edges = 4", "at least 8"],
        ),
        ("[discharge]\ncuts = 1.0", ["line 4", "1 is not on the rod"]),
        (
            "[discharge]\ncuts = [0.1, 0.1001]",
            ["line 4: discharge.cuts = 0.1,0.1001", "same vertex"],
        ),
        (
            "[discharge]\ncuts = \"all:201\"",
            ["line 4: discharge.cuts = all:201", "200 edges"],
        ),
        (
            "[discharge.ends]\nmotions = [{ velocity = [1, 0, 0] }, {}]",
            ["line 3: discharge.ends =", "pin or clamp"],
        ),
        (
            "[discharge.load]\nspring = -0.5",
            ["line 4: discharge.load.spring = -0.5", "zero or above"],
        ),
        (
            "[discharge.load]\nspring = 0.5\ndashpot = [0.1, -2]",
            ["line 5: discharge.load.dashpot = -2", "zero or above"],
        ),
        (
            "[discharge.load]\nrest_length = 2.0",
            ["line 3: discharge.load =", "give one of them"],
        ),
        (
            "[discharge.load]\nbetween = \"last\"\ndashpot = 1",
            [
                "line 4: discharge.load.between = \"last\"",
                "pin or clamp it in `discharge.ends`",
            ],
        ),
        (
            "[discharge.ends]\nconditions = [\"free\", \"clamped\"]\n[discharge.load]\nbetween = \"last\"\ndashpot = 1",
            [
                "line 6: discharge.load.between = \"last\"",
                "nothing would hold the rod",
            ],
        ),
        (
            "[discharge.load]\ndashpot = 1\ndirection = [0, 0, 1]",
            [
                "line 5: discharge.load.direction = [0, 0, 1]",
                "leave it out",
            ],
        ),
        (
            "[discharge.ends]\nconditions = [\"pinned\", \"free\"]\n[discharge.load]\nbetween = \"last\"\nspring = 1\nrest_length = 3",
            ["line 5: discharge.load =", "`direction`"],
        ),
        (
            "twist = 1\n[charge.twisting]\nover = 0",
            ["line 5: charge.twisting.over = 0", "above zero"],
        ),
        (
            "[charge.twisting]\nover = 2",
            ["line 3: charge.twisting", "give `twist`"],
        ),
        (
            "[discharge]\ncuts = \"let-go\"",
            ["line 4: discharge.cuts = let-go", "say where to cut"],
        ),
        (
            "twist = 1\n[charge.twisting]\nover = 5\ntorque = [[0, 0], [2, 1], [1, 1]]",
            ["line 6: charge.twisting.torque", "in the order of time"],
        ),
        (
            "twist = 1\n[charge.twisting]\nover = 5\ntorque = { to = 1, over = 0 }",
            ["line 6: charge.twisting.torque", "a time above zero"],
        ),
    ]);
}

#[test]
fn what_changes_nothing_is_refused() {
    assert_refused(&[
        (
            "reading = \"own-length\"\nslenderness = 50",
            ["line 4: rod.slenderness = 50", "own-length"],
        ),
        (
            "reading = [\"own-length\", \"hard\"]\nslenderness = [40, 50]",
            ["line 4: rod.slenderness", "own-length"],
        ),
        (
            "poisson_ratio = 0.2",
            ["line 3: rod.poisson_ratio = 0.2", "give `twist`"],
        ),
        (
            "imperfection = 0\nseed = 3\n[discharge]\nclosures = 0",
            ["line 4: rod.seed = 3", "leave it out"],
        ),
        (
            "[rod.friction]\nratio = 0\nrange = \"contact\"",
            ["line 5: rod.friction.range = \"contact\"", "ratio 0"],
        ),
        (
            "[accuracy]\ngamma = 1.0",
            ["line 4: accuracy.gamma = 1.0", "ros2w"],
        ),
        (
            "[accuracy]\nintegrator = \"rkc2\"\nreuse = 2",
            ["line 5: accuracy.reuse = 2", "explicit"],
        ),
    ]);
}

#[test]
fn nothing_absurd_is_begun() {
    assert_refused(&[
        (
            "[discharge]\nclosures = 1000000000000",
            [
                "line 4: discharge.closures = 1000000000000",
                "at most 100000",
            ],
        ),
        (
            "[accuracy]\nedges = 1000000000",
            ["line 4: accuracy.edges = 1000000000", "3.000e5 GB"],
        ),
        (
            "twist = { from = 0, to = 1, n = 1000 }\nslenderness = { from = 40, to = 60, n = 1000 }",
            [
                "= 1000000 cases",
                "rod.twist (1000), rod.slenderness (1000)",
            ],
        ),
        (
            "slenderness = { from = 0, to = 1, n = 1000000000000 }",
            ["line 3: rod.slenderness.n = 1000000000000", "1 to 100000"],
        ),
    ]);
}

#[test]
fn knots_named_twice_are_refused() {
    for (knots, words) in [
        (
            "[\"3_1\", \"4_1\", \"3_1\"]",
            ["line 2: rod.knot = 3_1", "3_1 is there already"],
        ),
        (
            "[\"all\", \"5_2\"]",
            ["line 2: rod.knot = 5_2", "5_2 is there already"],
        ),
        (
            "[\"granny\", \"3_1#3_1\"]",
            ["line 2: rod.knot = 3_1#3_1", "is there already"],
        ),
    ] {
        let message = parse(&format!("[rod]\nknot = {knots}"))
            .expect_err(knots)
            .to_string();
        for word in words {
            assert!(message.contains(word), "{knots} gives {message:?}");
        }
        // a table of one's own is looked at when the cases are made
        let own = parse(&format!("knots = \"own\"\n[rod]\nknot = {knots}"));
        if let Ok(scene) = own {
            let message = scene.cases(&KnotTable::builtin()).unwrap_err().to_string();
            assert!(
                message.contains("scene: rod.knot = ") && message.contains(words[1]),
                "{message}"
            );
        }
    }
}

#[test]
fn a_goal_sets_the_edges_of_every_case() {
    let table = KnotTable::builtin();
    let text = format!("accuracy = 0.05\n{KNOT}twist = 1.0\nslenderness = [40, 50]");
    let scene = parse(&text).unwrap();
    assert_eq!(parse(&scene.text()).unwrap(), scene);
    let (chosen, choice) = scene.with_chosen_settings(&table, 1).unwrap();
    let choice = choice.unwrap();
    let cases = chosen.cases(&table).unwrap();
    assert!(
        cases.len() == 2
            && cases
                .iter()
                .all(|c| c.rod.n_edges == choice.point.resolution as usize)
    );
    let row = |case: &ElasticCase, cut| topo_analysis::SweepRow {
        case: chosen.case_name(case),
        cut,
        ..Default::default()
    };
    let edges = parse(&format!("{KNOT}[accuracy]\nedges = [60, 90]")).unwrap();
    let asked = ElasticScene {
        goal: scene.goal,
        ..edges
    };
    assert_eq!(
        asked
            .with_chosen_settings(&table, 1)
            .unwrap()
            .0
            .cases(&table)
            .unwrap()
            .len(),
        1
    );
    let row = row(&cases[0], 0.25);
    let check = chosen.check_of(&table, &choice, &[row]).unwrap();
    assert_eq!(check.fixed_cuts.as_ref().unwrap().len(), 1);
    let budget = parse(&format!("budget = \"1h\"\n{KNOT}")).unwrap();
    assert_eq!(parse(&budget.text()).unwrap(), budget);
}
