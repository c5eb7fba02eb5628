"""A picture of each choice: error against run time, before the peak and beyond it, discs and spheres."""
import math


def pictures(rows, output):
    try:
        from matplotlib.figure import Figure
        from matplotlib.ticker import NullFormatter
    except ImportError:
        print("no pictures: matplotlib is not installed (Debian: python3-matplotlib)")
        return
    beside = [row for row in rows if row["choice"] == "YADE"]
    for choice in dict.fromkeys(row["choice"] for row in rows if row["choice"] != "YADE"):
        chosen = [row for row in rows if row["choice"] == choice]
        columns = list(dict.fromkeys(row["range"] for row in chosen))
        kinds = list(dict.fromkeys(row["kind"] for row in chosen))
        figure = Figure(figsize=(4.2 * len(columns), 3.4 * len(kinds)), layout="constrained")
        panels = figure.subplots(len(kinds), len(columns), squeeze=False)
        for kind, line in zip(kinds, panels):
            for name, panel in zip(columns, line):
                here = [row for row in chosen if (row["kind"], row["range"]) == (kind, name) and math.isfinite(row.get("error[-]", math.nan))]
                _panel(panel, NullFormatter, here, [row for row in beside if (row["kind"], row["range"]) == (kind, name) and choice == "increment"])
                panel.set_title(f"{kind}, {name}", fontsize=10)
        for panel in panels[-1]:
            panel.set_xlabel("CPU time of 1 % of strain [ms]")
        for line in panels:
            line[0].set_ylabel("error of the stress [-]")
        figure.savefig(output / f"choices_{choice.replace(' ', '_')}.svg", metadata={"Date": None})


def _panel(panel, no_labels, rows, yade):
    panel.set_xscale("log")
    panel.set_yscale("log")
    for axis in (panel.xaxis, panel.yaxis):
        axis.set_minor_formatter(no_labels())
    panel.grid(True, which="both", linewidth=0.3)
    by_increment = bool(yade) or len({row["setting"] for row in rows}) == len(rows)
    for number, increment in enumerate([None] if by_increment else dict.fromkeys(row["increment[-]"] for row in rows)):
        here = rows if by_increment else [row for row in rows if row["increment[-]"] == increment]
        panel.plot([row["cpu[ms]"] for row in here], [row["error[-]"] for row in here], "o-", color=("#0072b2", "#d55e00")[number],
                   label="grainlaw" if by_increment else f"increments of {100 * increment:g} %")
    for row in rows:
        panel.annotate(row["setting"], (row["cpu[ms]"], row["error[-]"]), textcoords="offset points", xytext=(4, 4), fontsize=7)
    if yade:
        panel.plot([row["cpu[ms]"] for row in yade], [row["error[-]"] for row in yade], "s--", color="#222222", label="YADE, by steps")
    spreads = {row["spread[-]"] for row in rows if row.get("spread[-]")}
    if len(spreads) == 1:
        panel.axhline(spreads.pop(), color="#999999", linewidth=1, label="one path of the reference")
    panel.legend(fontsize=7)
