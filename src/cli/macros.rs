//! Macro programs on the command line: how they are read, where the programs they call are found.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;

use super::dialects;
use super::failure::{Exit, Failure};
use super::kind::Kind;
use super::source::{Size, unreadable};
use crate::check::Severity;
use crate::formats::ReadError;
use crate::macros::binary::Binary;
use crate::macros::decimal::Decimal;
use crate::macros::expanded::{Expanded, Step};
use crate::macros::findings::{Finding, MacroError, NEVER_RUNS};
use crate::macros::form::Form;
use crate::macros::number::Number;
use crate::macros::options::Skip;
use crate::macros::printer::Printer;
use crate::macros::program::{Program, Programs};
use crate::macros::starvation::Line;
use crate::profile::{Arithmetic, Profile};

/// How a macro program is run.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Macro programs")]
pub(super) struct MacroOptions {
    /// Where the programs are that it calls and does not hold: files named O1234, with any suffix [default: nowhere]
    #[arg(long, value_name = "DIR")]
    pub(super) programs: Option<PathBuf>,
    /// How often a main program that ends with M99 runs [default: M99 there is refused]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(super) repeat: Option<u64>,
    /// Steps without a block after which a program is taken for one that never ends [default: 100000000]
    #[arg(long, value_name = "STEPS", value_parser = clap::value_parser!(u64).range(1..))]
    pub(super) budget: Option<u64>,
    /// Levels of `/` whose switch is on, such as 1,3: those blocks are left out; `none`: all are run [default: `/` stays]
    #[arg(long, value_name = "LEVELS")]
    pub(super) skip: Option<String>,
    /// What #3011 and #3012 say, as YYYYMMDD,HHMMSS [default: they are refused]
    #[arg(long, value_name = "DATE,TIME")]
    pub(super) date_time: Option<String>,
}

/// A macro program that was read, and how its lines are made.
#[derive(Clone, Debug)]
pub(super) struct MacroProgram {
    program: Arc<Program>,
    form: Form,
    arithmetic: Arithmetic,
    suppress: bool,
    /// What was told of it when it was read.
    told: Vec<MacroError>,
}

impl MacroProgram {
    /// Reads a program for a machine. All that is wrong with it is told, but for the last, which is the failure; so are
    /// warnings.
    pub(super) fn parse(
        name: &str,
        text: &[u8],
        options: &MacroOptions,
        profile: &Profile,
        dialect: Option<&str>,
        suppress: bool,
    ) -> Result<Self, Failure> {
        let mut form = profile.form.clone();
        if let Some(dialect) = dialect.or(profile.dialect.as_deref()) {
            form = form.of_dialect(&dialects::load(Some(dialect), "written")?);
        }
        let rules = options.rules(profile)?;
        let mut programs = Directory::open(options.programs.as_deref())?;
        let program = Program::parse(text, &mut programs, &rules).map_err(|errors| {
            let mut errors = errors.into_iter().map(|error| failure(name, error));
            let last = errors.next_back();
            for error in errors {
                say!("{}", error.render().trim_end());
            }
            last.unwrap_or_else(|| Failure::new(Exit::Program, format!("{name} cannot be read")))
        })?;
        let (mut errors, warnings): (Vec<Finding>, Vec<Finding>) = foreseen(&program, profile.arithmetic)
            .into_iter()
            .partition(|finding| finding.severity == Severity::Error);
        say_findings(name, &warnings);
        let told = warnings.iter().map(|finding| finding.error.clone()).collect();
        // A program that is foreseen to break is not begun.
        if let Some(last) = errors.pop() {
            say_findings(name, &errors);
            return Err(failure(name, last.error));
        }
        Ok(Self { program: Arc::new(program), form, arithmetic: profile.arithmetic, suppress, told })
    }

    /// Tells what was noticed while it ran, but for what was told before.
    pub(super) fn say_noticed(&self, name: &str, findings: &[Finding]) {
        let is_told = |found: &Finding| {
            self.told
                .iter()
                .any(|told| (told.code, told.place.line) == (found.error.code, found.error.place.line))
        };
        for finding in findings.iter().filter(|finding| !is_told(finding)) {
            say_findings(name, std::slice::from_ref(finding));
        }
    }

    /// Runs the beginning of a program to see what is coming: what breaks early is found before the first byte.
    pub(super) fn forecast(&self, name: &str, line: Line) -> Result<Forecast, Failure> {
        match self.lines() {
            Lines::Decimal(lines) => ahead(name, lines.over(line)),
            Lines::Binary(lines) => ahead(name, lines.over(line)),
        }
    }

    /// Its lines, from the first.
    pub(super) fn lines(&self) -> Lines {
        let printer = Printer::new(self.form.clone(), self.suppress);
        match self.arithmetic {
            Arithmetic::Decimal => {
                Lines::Decimal(Box::new(Expanded::new(Arc::clone(&self.program), printer)))
            }
            Arithmetic::Binary => Lines::Binary(Box::new(Expanded::new(Arc::clone(&self.program), printer))),
        }
    }
}

/// What can be said of a program before it is fed, as far as it was run.
#[derive(Debug)]
pub(super) struct Forecast {
    /// Why it is not worth running: it moves nothing.
    pub(super) idle: Option<Failure>,
    /// What was noticed.
    pub(super) findings: Vec<Finding>,
    /// Whether the line keeps up, in words, where it does not.
    pub(super) starvation: Option<String>,
    /// Its length, where the end was reached.
    pub(super) size: Option<Size>,
}

fn ahead<N: Number>(name: &str, mut lines: Expanded<N>) -> Result<Forecast, Failure> {
    let (mut size, mut text) = (Size { blocks: 0, lines: 0, bytes: 0 }, Vec::new());
    let mut is_whole = false;
    let mut turns = 0;
    while size.lines < FORECAST_LINES && turns < FORECAST_TURNS {
        text.clear();
        match lines.next_line(FORECAST_FUEL, &mut text).map_err(|error| Failure::read(name, error))? {
            step @ (Step::Block | Step::Remark) => {
                size.blocks += u64::from(step == Step::Block);
                size.lines += 1;
                size.bytes += text.len() as u64;
            }
            Step::Working => turns += 1,
            Step::End => {
                is_whole = true;
                break;
            }
        }
    }
    let idle = (is_whole && !lines.moves()).then(|| idle(name, lines.findings()));
    let starvation = lines.account().and_then(|account| account.text());
    let findings = lines.findings().to_vec();
    Ok(Forecast { idle, findings, starvation, size: is_whole.then_some(size) })
}

/// A program that moves nothing; most likely for a loop that does not run.
fn idle(name: &str, findings: &[Finding]) -> Failure {
    match findings.iter().find(|finding| finding.error.code == NEVER_RUNS) {
        Some(finding) => {
            let mut shown = failure(name, finding.error.clone());
            shown.prefix("the program moves nothing");
            shown
        }
        None => Failure::new(Exit::Program, format!("{name} moves nothing"))
            .help("it holds or makes no block with a coordinate"),
    }
}

/// How much of a program is run before it is fed: a part of a second.
const FORECAST_LINES: u64 = 100_000;
const FORECAST_FUEL: u32 = 1 << 20;
const FORECAST_TURNS: u32 = 8;

/// Lines of a macro program, by what it counts with.
pub(super) enum Lines {
    Decimal(Box<Expanded<Decimal>>),
    Binary(Box<Expanded<Binary>>),
}

impl Lines {
    /// As a program to be fed.
    pub(super) fn into_program(self) -> Box<dyn crate::program::Program> {
        match self {
            Self::Decimal(lines) => lines,
            Self::Binary(lines) => lines,
        }
    }
}

/// The whole text: what may be gone to must be there.
pub(super) fn text_of(word: &str) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::new();
    let (name, read) = match word {
        "-" => ("standard input", io::stdin().lock().read_to_end(&mut text)),
        file => (file, File::open(file).and_then(|mut file| file.read_to_end(&mut text))),
    };
    read.map_err(|error| unreadable(name, &error))?;
    Ok(text)
}

/// The line of a machine, as far as its profile says.
pub(super) fn line_of(profile: &Profile) -> Line {
    Line {
        rate: f64::from(profile.baud) / f64::from(profile.framing.bits()),
        buffer: profile.buffer_bytes as f64,
        end_of_block: profile.tape.end_of_block.len(),
    }
}

/// What is found without running a program, errors first.
fn foreseen(program: &Program, arithmetic: Arithmetic) -> Vec<Finding> {
    match arithmetic {
        Arithmetic::Decimal => program.check::<Decimal>(),
        Arithmetic::Binary => program.check::<Binary>(),
    }
}

/// Tells what was noticed and is no error.
fn say_findings(name: &str, findings: &[Finding]) {
    for finding in findings {
        let MacroError { code, .. } = finding.error;
        let word = match finding.severity {
            Severity::Error => format!("error[{code}]:"),
            Severity::Warning => format!("warning[{code}]:"),
        };
        let shown = failure(name, finding.error.clone()).called(word);
        say!("{}", shown.render().trim_end());
    }
}

fn failure(name: &str, error: MacroError) -> Failure {
    let file = error.program.map_or_else(|| name.to_owned(), |number| format!("O{number:04}"));
    Failure::read(&file, ReadError::from(error))
}

impl MacroOptions {
    /// Refuses them where no macro program is run.
    pub(super) fn check_unused(&self, word: &str, kind: Kind) -> Result<(), Failure> {
        let given = [
            (self.programs.is_some(), "--programs"),
            (self.repeat.is_some(), "--repeat"),
            (self.budget.is_some(), "--budget"),
            (self.skip.is_some(), "--skip"),
            (self.date_time.is_some(), "--date-time"),
        ];
        match given.into_iter().find(|(given, _)| *given) {
            None => Ok(()),
            Some((_, option)) => {
                let message = format!("{option} goes with a macro program, and {word} is {}", kind.title());
                Err(Failure::new(Exit::Usage, message).help("leave it out, or say --from macro"))
            }
        }
    }

    fn rules(&self, profile: &Profile) -> Result<crate::macros::options::Options, Failure> {
        let mut rules = profile.macros.clone();
        rules.repeat = self.repeat.or(rules.repeat);
        rules.budget = self.budget.unwrap_or(rules.budget);
        if let Some(levels) = &self.skip {
            rules.skip = Skip::Switches(switches(levels)?);
        }
        if let Some(text) = &self.date_time {
            rules.date_time = Some(date_time(text)?);
        }
        Ok(rules)
    }
}

/// `1,3` or `none`.
fn switches(levels: &str) -> Result<u16, Failure> {
    if levels == "none" {
        return Ok(0);
    }
    levels.split(',').try_fold(0, |switches, level| match level.trim().parse::<u16>() {
        Ok(level @ 1..=9) => Ok(switches | 1 << level),
        _ => Err(Failure::new(Exit::Usage, format!("--skip {levels}: a level is from 1 to 9"))
            .help("for example --skip 1, --skip 1,3, or --skip none")),
    })
}

/// `20261129,134501`.
fn date_time(text: &str) -> Result<(u32, u32), Failure> {
    let is = |text: &str, digits: usize| text.len() == digits && text.bytes().all(|b| b.is_ascii_digit());
    match text.split_once(',') {
        Some((date, time)) if is(date, 8) && is(time, 6) => {
            Ok((date.parse().unwrap_or_default(), time.parse().unwrap_or_default()))
        }
        _ => Err(Failure::new(Exit::Usage, format!("--date-time {text} is not YYYYMMDD,HHMMSS"))
            .help("for example --date-time 20261129,134500")),
    }
}

/// Programs in a directory, by number.
#[derive(Debug, Default)]
struct Directory {
    files: BTreeMap<u32, Vec<PathBuf>>,
}

impl Directory {
    fn open(path: Option<&Path>) -> Result<Self, Failure> {
        let Some(path) = path else { return Ok(Self::default()) };
        let mut files = BTreeMap::<u32, Vec<PathBuf>>::new();
        let name = path.display().to_string();
        for entry in std::fs::read_dir(path).map_err(|error| unreadable(&name, &error))? {
            let file = entry.map_err(|error| unreadable(&name, &error))?.path();
            let stem = file.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
            let digits = stem.strip_prefix(['O', 'o']).unwrap_or(stem);
            if let Ok(number) = digits.parse()
                && digits.bytes().all(|b| b.is_ascii_digit())
                && file.is_file()
            {
                files.entry(number).or_default().push(file);
            }
        }
        Ok(Self { files })
    }
}

impl Programs for Directory {
    fn load(&mut self, number: u32) -> Result<Option<Vec<u8>>, String> {
        match self.files.get(&number).map(Vec::as_slice) {
            None | Some([]) => Ok(None),
            Some([file]) => std::fs::read(file)
                .map(Some)
                .map_err(|error| format!("cannot read {}: {error}", file.display())),
            Some([first, second, ..]) => {
                Err(format!("{} and {} are both O{number:04}", first.display(), second.display()))
            }
        }
    }

    fn numbers(&mut self) -> Result<Vec<u32>, String> {
        Ok(self.files.keys().copied().collect())
    }
}
