//! `jobs`, `machines` and `generate --explain`: what a newcomer looks at first.

use serde_json::Value;

use crate::scratch::{Ear, PROGRAM, Scratch};

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|wrong| panic!("{wrong} in {text:?}"))
}

#[test]
fn before_the_first_job_the_list_of_jobs_is_an_empty_array() {
    let scratch = Scratch::new();
    std::fs::create_dir(scratch.path().join("empty")).expect("a directory");
    for arguments in [
        &["jobs", "--json"][..],
        &["jobs", "--json", "--journal", "empty"],
        &["jobs", "--json", "--journal", "none"],
    ] {
        let run = scratch.run(arguments);
        assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""), "{arguments:?}");
        assert_eq!(json(&run.stdout), Value::Array(Vec::new()), "{arguments:?}");
    }
}

#[test]
fn looking_at_jobs_creates_nothing() {
    let scratch = Scratch::new();
    scratch.run(&["jobs"]);
    scratch.run(&["jobs", "--json", "--journal", "none"]);
    assert_eq!(std::fs::read_dir(scratch.path()).expect("the directory").count(), 0);
}

#[test]
fn a_directory_without_jobs_says_so_in_words() {
    let run = Scratch::new().run(&["jobs"]);
    assert_eq!(run.code, Some(0));
    assert!(run.stdout.contains("no job"), "{}", run.stdout);
}

#[test]
fn the_machines_are_an_array_of_named_objects() {
    let run = Scratch::new().run(&["machines", "--json"]);
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""));
    let machines = json(&run.stdout);
    let names: Vec<&str> = machines
        .as_array()
        .expect("an array")
        .iter()
        .map(|one| one["name"].as_str().expect("a name"))
        .collect();
    assert!(names.contains(&"generic-iso"), "{names:?}");
}

#[test]
fn every_machine_listed_is_shown_and_its_profile_is_in_order() {
    let scratch = Scratch::new();
    for machine in json(&scratch.run(&["machines", "--json"]).stdout).as_array().expect("an array") {
        let name = machine["name"].as_str().expect("a name");
        let shown = scratch.run(&["machines", "show", name]);
        assert_eq!((shown.code, shown.stderr.as_str()), (Some(0), ""), "{name}");
        scratch.write("copied.toml", &shown.stdout);
        let checked = scratch.run(&["machines", "check", "copied.toml"]);
        assert_eq!(checked.code, Some(0), "{name}: {}", checked.stderr);
    }
}

/// Each value of a built-in profile has its source beside it, or it says that it is a guess.
#[test]
fn every_value_of_a_built_in_profile_says_where_it_comes_from() {
    let profile = Scratch::new().run(&["machines", "show", "generic-iso"]).stdout;
    for line in profile.lines().filter(|line| line.contains('=') && !line.starts_with('#')) {
        let is_the_name = line.starts_with("name");
        assert!(is_the_name || line.contains('#'), "{line:?} says nothing");
    }
}

#[test]
fn an_explained_part_file_builds_unedited_and_is_the_command_lines_default() {
    let scratch = Scratch::new();
    let explained = scratch.run(&["generate", "--explain", "gear"]);
    assert_eq!((explained.code, explained.stderr.as_str()), (Some(0), ""));
    assert!(explained.stdout.lines().filter(|line| line.contains('#')).count() > 10, "it is commented");
    scratch.write("gear.toml", &explained.stdout);
    let built = scratch.run(&["generate", "gear.toml"]);
    assert_eq!(built.code, Some(0), "{}", built.stderr);
    let typed = scratch.run(&["generate", "gear"]);
    assert_eq!(built.stdout, typed.stdout);
    assert_eq!(built.stderr, typed.stderr);
}

#[test]
fn without_a_named_machine_the_profile_is_printed_in_full_before_the_port_is_opened() {
    let scratch = Scratch::with(&[("good.3b", PROGRAM)]);
    let run = scratch.run(&["send", "good.3b", "--port", "/dev/no-such-port"]);
    assert_eq!((run.code, run.stdout.as_str()), (Some(5), ""), "{}", run.stderr);
    let profile = scratch.run(&["machines", "show", "generic-iso"]).stdout;
    let place = run.stderr.find(profile.trim_end()).expect("the profile, word for word");
    assert!(place < run.stderr.find("error: ").expect("an error"));
}

#[test]
fn with_a_named_machine_the_profile_is_not_printed() {
    let scratch = Scratch::with(&[("good.3b", PROGRAM)]);
    let run = scratch.run(&["send", "good.3b", "--port", "/dev/no-such-port", "--machine", "generic-iso"]);
    assert_eq!(run.code, Some(5), "{}", run.stderr);
    assert!(!run.stderr.contains("overrun_limit"), "{}", run.stderr);
}

#[test]
fn a_wrong_profile_is_exit_4_and_nobody_is_called() {
    let scratch = Scratch::with(&[
        ("good.3b", PROGRAM),
        ("m.toml", "[machine]\nname = \"m\"\n\n[link]\nbuad = 9600\n"),
    ]);
    let ear = Ear::new();
    let run = scratch.run(&["send", "good.3b", "--port", &ear.port(), "--machine", "m.toml"]);
    assert_eq!((run.code, run.stdout.as_str()), (Some(4), ""), "{}", run.stderr);
    assert!(run.stderr.contains("buad") && run.stderr.contains("did you mean `baud`"), "{}", run.stderr);
    assert!(!ear.has_been_called() && !scratch.has_journals());
    let check = scratch.run(&["machines", "check", "m.toml"]);
    assert_eq!(check.code, Some(4), "{}", check.stderr);
}
