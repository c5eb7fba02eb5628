#!/usr/bin/env python3
"""Statements of the papers and the ladder of known numbers: the tables of bounds, the facts that studies wrote, and the one place
where both become a verdict.

  statements.py page                            writes report/statements.md
  statements.py tests BUILD OUTPUT [FACT ...]   runs the tests that statements name; their failures are facts, in OUTPUT
  statements.py collect OUTPUT                  keeps the facts of a run, *_facts.csv in OUTPUT, in the folder facts, and the core
                                                times in its everything.csv
  statements.py core_time [EVERYTHING.csv]      core time of all measurements, with those of which none is recorded
"""
import collections
import csv
import math
import pathlib
import re
import subprocess
import sys
import tomllib

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import core_time

HERE = pathlib.Path(__file__).resolve().parent
TABLES = ("papers/statements.toml", "ladder/ladder.toml")
PAGE = HERE / "report/statements.md"
VERDICTS = ("agrees", "differs", "fitted", "not run")
KINDS = {"Fig": "Figures", "Table": "Tables", "eq": "Equations"}
Fact = collections.namedtuple("Fact", "value commit machine")


def load(text_of=lambda name: (HERE / name).read_text(encoding="utf-8")):
    """Papers by letter and rows by id; `text_of` reads a table by its name."""
    papers, rows = {}, {}
    for name in TABLES:
        content = tomllib.loads(text_of(name))
        papers.update(content["papers"])
        for row in content["statement"]:
            if row["id"] in rows:
                raise SystemExit(f"{name}: {row['id']} stands there twice")
            rows[row["id"]] = row
    return papers, rows


def read_facts(directory=HERE / "facts"):
    facts = {}
    for path in sorted(directory.glob("*.csv")):
        with open(path, newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                facts[row["fact"]] = Fact(float(row["value"]), row["commit"], row["machine"])
    return facts


def within(bound, value):
    return bound.get("from", value) <= value <= bound.get("to", value)


def verdict(row, facts):
    """One bound that fails is enough to differ, one fact that is missing to be not run. Not a number fails."""
    known = [(bound, facts[bound["fact"]].value) for bound in row["bounds"] if bound.get("fact") in facts]
    if not all(within(bound, value) for bound, value in known):
        return "differs"
    if len(known) < len(row["bounds"]):
        return "not run"
    return "fitted" if "fitted" in row else "agrees"


def missed(row, facts):
    """Bounds that a number of ours is not within, with the number, worst first."""
    known = [(bound, facts[bound["fact"]].value) for bound in row["bounds"] if bound.get("fact") in facts]
    return sorted(((bound, value) for bound, value in known if not within(bound, value)), key=lambda pair: -distance(*pair))


def distance(bound, value):
    """How many times a number is the end of the bound that it misses, or the end the number; 1 on the bound."""
    end = bound["to"] if value > bound.get("to", math.inf) else bound.get("from", math.nan)
    return max(value / end, end / value) if value * end > 0 else math.inf


def number(value):
    return f"{value:.4g}"


def text_of_bound(bound):
    ends = [number(bound[end]) for end in ("from", "to") if end in bound]
    if len(ends) == 2:
        return ends[0] if ends[0] == ends[1] else f"{ends[0]} to {ends[1]}"
    return ("at least " if "from" in bound else "at most ") + ends[0]


def name_of_bound(bound):
    if "measure" in bound:
        return bound["measure"]
    what = bound["fact"].split(".", 1)
    return f"failed tests of {what[1]}" if what[0] == "tests" else re.sub(r"(?<!\d)\.|\.(?!\d)", ", ", what[1].replace("_", " "))


def cells(row, facts):
    """What a page shows of a row: every bound with its number beside it."""
    here = [number(facts[bound["fact"]].value) if bound.get("fact") in facts else "-" for bound in row["bounds"]]
    note = f"needs: {row['needs']}" if "needs" in row else f"chosen: {row['fitted']}" if "fitted" in row else row["source"]
    return [f"{row['says']} ({', '.join(row['place'])})", row["value"],
            "; ".join(f"{name_of_bound(bound)}: {text_of_bound(bound)}" for bound in row["bounds"]), "; ".join(here),
            verdict(row, facts), note]


def git(*arguments):
    """Its output; nothing where git or what is asked for is not there."""
    try:
        return subprocess.run(["git", "-C", HERE, *arguments], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return None


def bounds_set_later(rows, facts):
    """Rows whose bounds were other ones in the commit of a fact that they are held against, where that commit is known."""
    at = {}
    for commit in {fact.commit for fact in facts.values()}:
        texts = {name: git("show", f"{commit}:./{name}") for name in TABLES}
        if None not in texts.values():
            at[commit] = load(texts.get)[1]
    return [(key, facts[bound["fact"]].commit) for key, row in rows.items() for bound in row["bounds"]
            if bound.get("fact") in facts and facts[bound["fact"]].commit in at and
            bound not in at[facts[bound["fact"]].commit].get(key, {"bounds": []})["bounds"]]


DIFFERENCES = ["id", "statement", "worst bound missed", "here", "how far", "why"]


def differences(rows, facts):
    """The table of what differs, worst first."""
    worst = {row["id"]: missed(row, facts)[0] for row in rows if verdict(row, facts) == "differs"}
    yield line_of(DIFFERENCES)
    yield "|" + "---|" * len(DIFFERENCES)
    for row in sorted((row for row in rows if row["id"] in worst), key=lambda row: -distance(*worst[row["id"]])):
        bound, value = worst[row["id"]]
        yield line_of([row["id"], row["says"], f"{name_of_bound(bound)}: {text_of_bound(bound)}", number(value),
                       number(distance(bound, value)).replace("inf", "infinite"), row.get("why", "-")])


HEAD = ["statement", "paper", "bounds", "here", "verdict", "bounds from, or what is missing"]


def line_of(texts):
    return "| " + " | ".join(text.replace("|", "\\|") for text in texts) + " |"


def table_of(rows, facts, paper="paper"):
    head = ["id", *HEAD]
    head[2] = paper
    return [line_of(head), "|" + "---|" * len(head)] + [line_of([row["id"], *cells(row, facts)]) for row in rows]


def of_paper(rows, letter):
    return [row for key, row in rows.items() if key[0] == letter]


def kind_of(place):
    return next((kind for start, kind in KINDS.items() if place.startswith(start)), "Text")


def in_order(place):
    """Figure 10 after figure 9."""
    return [part.zfill(6) if part.isdigit() else part for part in re.split(r"(\d+)", place)]


def index_of(rows):
    """Lines "Figures: ...", each place with the statements on it."""
    places = collections.defaultdict(lambda: collections.defaultdict(list))
    for row in rows:
        for place in row["place"]:
            places[kind_of(place)][place].append(row["id"])
    for kind in (*KINDS.values(), "Text"):
        if places[kind]:
            yield f"- {kind}: " + "; ".join(f"{place}: {', '.join(places[kind][place])}" for place in sorted(places[kind], key=in_order))


def counts_of(rows, facts):
    found = collections.Counter(verdict(row, facts) for row in rows)
    return [found[word] for word in VERDICTS]


def runs_of(facts):
    """Which commit and machine the facts are of, with how many of them."""
    found = collections.Counter((fact.commit, fact.machine) for fact in facts.values())
    return [line_of([commit, machine, str(count)]) for (commit, machine), count in sorted(found.items())]


def page_text():
    papers, rows = load()
    facts = read_facts()
    lines = ["# Every statement of the papers, and known numbers", "",
             "Made by `verification/run statements`; do not edit. Each statement has bounds, which were set before these runs,",
             "and numbers of ours, which studies write as facts. A statement agrees when every number is within its bounds.",
             "It differs when one is not. It is fitted when it agrees because something was chosen after a result.",
             "It is not run when a number is missing. The bounds stand in `verification/evidence/papers/statements.toml` and",
             "`verification/evidence/ladder/ladder.toml`.", "", line_of(["", *VERDICTS, "all"]), "|" + "---|" * 6]
    for letter, paper in papers.items():
        counts = counts_of(of_paper(rows, letter), facts)
        lines.append(line_of([paper["name"], *map(str, [*counts, sum(counts)])]))
    lines += ["", line_of(["commit", "machine", "facts"]), "|---|---|---|", *runs_of(facts), "", *core_time.section(facts), "",
              "## What differs, worst first", "",
              "How far: the number here over the end of the bound that it misses, or the end over the number, whichever is above 1.",
              "So 1 is the bound itself, and 2 is twice too much or half of it. It is infinite where one of the two is zero.", "",
              *differences(rows.values(), facts)]
    for letter, paper in papers.items():
        mine = of_paper(rows, letter)
        lines += ["", f"## {paper['name']}", ""]
        if paper["page"]:
            lines += [f"Its curves and tables are on [its page]({paper['page']}).", ""]
            lines += [*index_of(mine), ""]
        lines += table_of(mine, facts)
    return "\n".join(lines) + "\n"


def tests_named():
    return sorted({bound["fact"] for row in load()[1].values() for bound in row["bounds"] if bound.get("fact", "").startswith("tests.")})


def write_facts(path, values, commit, machine):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["fact", "value", "commit", "machine"])
        writer.writerows([name, f"{value:.10g}", commit, machine] for name, value in values.items())


def machine_of(output):
    """Commit and processor from machine.csv, which verification/run leaves beside results."""
    with open(output / "machine.csv", newline="", encoding="utf-8") as file:
        told = {row[0]: row[1] for row in csv.reader(file) if len(row) > 1}
    return told["revision"], told["processor"]


def pattern_of(fact):
    """The tests of a suite, those with parameters too: driver.patch.x, driver.elements/patch.x/t3."""
    kind, suite = fact.removeprefix("tests.").split(".")
    return f"^{kind}[.]([^.]*/)?{suite}[.]"


def run_tests(build, output, *names):
    """All that statements name, or these; written after each, beside what the same commit left."""
    path, told_of = output / "tests_facts.csv", machine_of(output)
    failures = {}
    if path.exists():
        with open(path, newline="", encoding="utf-8") as file:
            failures = {row["fact"]: int(row["value"]) for row in csv.DictReader(file) if (row["commit"], row["machine"]) == told_of}
    for name in names or tests_named():
        what = name.removeprefix("tests.")
        done = subprocess.run(["ctest", "--test-dir", build, "-R", pattern_of(name)], stdout=subprocess.PIPE, text=True)
        told = re.search(r"(\d+) tests failed out of (\d+)", done.stdout)
        if not told or told[2] == "0":
            print(f"{what}: left out, {build} has no such test", flush=True)
            continue
        failures[name] = int(told[1])
        print(f"{what}: {told[1]} of {told[2]} failed", flush=True)
        write_facts(path, failures, *told_of)


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        return {row["fact"]: row for row in csv.DictReader(file)}


def collect(output, kept=HERE / "facts"):
    """Nothing of a tree with changes: nobody could make it again. What a run of some scenes did not measure stays as it was."""
    kept.mkdir(exist_ok=True)
    for path in sorted(output.glob("*_facts.csv")):
        found = rows_of(path)
        commits = {row["commit"] for row in found.values()}
        if any(commit == "unknown" or commit.endswith("-dirty") for commit in commits):
            raise SystemExit(f"{path}: of {', '.join(commits)}, expected a commit without changes")
        into = kept / path.name.replace("_facts", "")
        found = (rows_of(into) if into.exists() else {}) | found
        with open(into, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, ["fact", "value", "commit", "machine"], lineterminator="\n")
            writer.writeheader()
            writer.writerows(found.values())
        print("kept", path.name)
    if (output / "everything.csv").exists():
        core_time.keep(output / "everything.csv", machine_of(output)[1])


def main(command, *arguments):
    if command == "page":
        PAGE.write_text(page_text(), encoding="utf-8")
        print("wrote", PAGE)
    elif command == "tests":
        run_tests(arguments[0], pathlib.Path(arguments[1]), *arguments[2:])
    elif command == "collect":
        collect(pathlib.Path(arguments[0]))
    elif command == "core_time":
        print("\n".join(core_time.section(read_facts(), *arguments)))
    else:
        raise SystemExit(__doc__)


if __name__ == "__main__":
    main(*(sys.argv[1:] or ["help"]))
