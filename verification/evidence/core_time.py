"""Core time of all measurements, by what their runs recorded: a line of `verification/run everything`, kept in core_time.csv, or
else the scenes of a paper, on its page and in the facts."""
import csv
import pathlib
import re
import subprocess
import sys

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
KEPT = HERE / "core_time.csv"
COLUMNS = ["measurement", "commit", "machine", "core_time[s]"]


def measurements():
    """As `verification/run everything` lists them."""
    listed = subprocess.run([HERE.parent / "everything", "-", "--list"], stdout=subprocess.PIPE, text=True, check=True)
    return listed.stdout.splitlines()


def read(path):
    if not path.exists():
        return {}
    with open(path, newline="", encoding="utf-8") as file:
        return {row[COLUMNS[0]]: row for row in csv.DictReader(file)}


def passed(path, machine):
    """The measurements of an everything.csv that passed."""
    with open(path, newline="", encoding="utf-8") as file:
        return {row["command"]: dict(zip(COLUMNS, (row["command"], row["commit"], machine, row["core_time[s]"])))
                for row in csv.DictReader(file) if row["outcome"] == "passed"}


def keep(path, machine, kept=KEPT):
    """One that was kept before is replaced."""
    rows = read(kept) | passed(path, machine)
    with open(kept, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows[name] for name in sorted(rows))


def cells_of(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def on_page(text):
    """Core seconds of all runs in the table of costs of a page; of runs of one name together. Nothing where there is none."""
    found = {}
    for head, rows in re.findall(r"^(\| (?:scene|run \[-\]) \|.*)\n\|[-|]+\n((?:\|.*\n)+)", text, re.M):
        columns = [name.split(" [")[0] for name in cells_of(head)]
        for column in {"core time", "core seconds"} & set(columns):
            for row in map(cells_of, rows.splitlines()):
                seconds = row[columns.index(column)]
                if seconds != "-":
                    found[row[0]] = found.get(row[0], 0.0) + float(seconds)
    return found


def of_scenes(name, facts):
    """By scene, the facts before the page."""
    page = HERE / f"report/{name}.md"
    found = on_page(page.read_text(encoding="utf-8")) if page.exists() else {}
    for fact, known in facts.items():
        match = re.fullmatch(name.split("_")[0] + r"\.(\w+)\.core_hours", fact)
        if match and known.value == known.value:
            found[match[1]] = 3600 * known.value
    return found


def table(facts, names, known):
    """Rows of measurement, core seconds or None, and what recorded them."""
    for name in names:
        if name in known:
            yield name, float(known[name][COLUMNS[3]]), f"one run, {known[name]['commit']}, {known[name]['machine']}"
            continue
        scenes = of_scenes(name, facts)
        yield name, sum(scenes.values()) or None, f"{len(scenes)} scenes" if scenes else "-"


def section(facts, just_run=None):
    """Lines of a page; what an everything.csv has counts before what is kept."""
    rows = list(table(facts, measurements(), read(KEPT) | (passed(just_run, "this machine") if just_run else {})))
    told = [row for row in rows if row[1] is not None]
    missing = [name for name, seconds, _ in rows if seconds is None]
    yield from ("## What all of it costs", "",
                "`verification/run everything` runs these, and notes the core time of each. Its last kept line counts here; of a",
                "paper without one the scenes on its page and in the facts, which leaves out their packings and pictures.", "",
                "| measurement | core seconds | recorded by |", "|---|---|---|")
    for name, seconds, source in told:
        yield f"| `{name}` | {seconds:.0f} | {source} |"
    yield ""
    yield f"Together {sum(row[1] for row in told) / 3600:.2f} core hours for {len(told)} of {len(rows)} measurements."
    if missing:
        yield f"No core time is recorded of: {', '.join(f'`{name}`' for name in missing)}."
