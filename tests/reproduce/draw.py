"""Draws the figures of tact-reproduce from the CSV and JSON files in a folder.

    python3 draw.py FOLDER          draws every figure whose data are in FOLDER, as PNG files in FOLDER
    python3 draw.py --self-test     draws each kind of figure from synthetic data in a temporary folder

Exit codes: 0 done; 1 error; 77 matplotlib is missing. tact-reproduce starts the script. Start it by hand to redraw the figures after a change here.
"""
import csv
import json
import math
import os
import sys
import tempfile

try:
    import matplotlib
except ImportError:
    sys.exit(77)
matplotlib.use("Agg")
import matplotlib.image as mpimg  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402
from matplotlib.patches import Patch  # noqa: E402

# Colours of Okabe and Ito, distinguishable with every kind of colour vision.
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#e69f00", "#56b4e9", "#cc79a7", "#000000"]
WINDOW_S = 0.1
SETTLE_S = 0.3
DPI = 110

plt.rcParams.update({"font.size": 10, "axes.grid": True, "grid.color": "#e4e4e4", "axes.axisbelow": True, "axes.spines.top": False,
                     "axes.spines.right": False, "axes.titlesize": 10, "legend.frameon": False, "legend.fontsize": 9, "lines.linewidth": 1.6})


def read_rows(path):
    """Reads the rows of a CSV file; converts numeric fields to numbers."""
    def value(text):
        try:
            return float(text)
        except ValueError:
            return text
    with open(path, encoding="utf-8", newline="") as f:
        return [{k: value(v) for k, v in row.items()} for row in csv.DictReader(f)]


def start(title, remark, panels, height=3.6, width=11.0):
    figure, axes = plt.subplots(panels, 1, sharex=True, squeeze=False, figsize=(width, 1.1 + height * panels), layout="constrained")
    # The title has two lines; the second, in smaller type, states the conditions.
    figure.suptitle(title, x=0.012, ha="left", fontsize=14)
    axes[0][0].set_title(remark, loc="left", color="#666666", pad=10)
    return figure, [a[0] for a in axes]


def legend(axes, handles=None):
    """Places the legend outside the axes, to the right."""
    options = {"loc": "upper left", "bbox_to_anchor": (1.005, 1.0), "borderaxespad": 0.0}
    if handles is not None:
        options["handles"] = handles
    axes.legend(**options)


def save(figure, folder, name):
    figure.align_ylabels()
    figure.savefig(os.path.join(folder, name), dpi=DPI)
    plt.close(figure)
    print(f"  {name}")


# Force rates over time (docking: figures 5, 7 and 8).
class Runs:
    def __init__(self, folder):
        self.case = {}
        for row in read_rows(os.path.join(folder, "rates.csv")):
            self.case.setdefault(row["case"], []).append(row)
        self.remark = "each point: rate over 0.1 s"
        report = os.path.join(folder, "docking.json")
        if os.path.exists(report):
            with open(report, encoding="utf-8") as f:
                rates = json.load(f)["rates"]
            most = max((r["triangles"] for rows in self.case.values() for r in rows), default=0)
            self.remark = (f"all processes on one core, {rates['conditions']['precedence']}; {rates['scale']['points_summed']} points summed, "
                           f"at most {most:.0f} triangles; {self.remark}")

    def goal(self, case):
        return self.case[case][0]["goal_hz"]

    def law(self, case):
        return self.case[case][0]["run"].split(",")[0]

    def end(self, case):
        return self.case[case][-1]["t_s"]

    @staticmethod
    def part(row):
        """Returns the part of the run: start, no_load or load. Files of earlier versions lack this column."""
        return row.get("part") or ("load" if row["external_load"] else "no_load")

    @staticmethod
    def reused(row):
        """Returns whether the updates of this window reused a part of earlier work."""
        return row.get("step_work_done_anew", 1.0) < 0.9995

    def load(self, case):
        """Returns start and end of the external load; without a load, infinity and the last time."""
        times = [r["t_s"] for r in self.case[case] if r["external_load"]]
        return (min(times), max(times)) if times else (math.inf, self.end(case))


def worst_rows(rows):
    """Returns the row with the lowest rate of each part of a run, except the start."""
    worst = {}
    for row in rows:
        part = Runs.part(row)
        if part != "start" and (part not in worst or row["force_rate_100ms_hz"] < worst[part]["force_rate_100ms_hz"]):
            worst[part] = row
    return worst


def worst_label(worst):
    def one(row):
        rate, goal = row["force_rate_100ms_hz"], row["goal_hz"]
        return f"{rate:.0f} Hz" + (f" ({100.0 * rate / goal:.0f} %)" if goal > 0 else "")
    parts = [f"{one(worst[part])} {name}" for part, name in (("no_load", "without load"), ("load", "with load")) if part in worst]
    return "\nworst 0.1 s: " + ",\n".join(parts) if parts else ""


def spans(rows, holds):
    """Returns the time intervals of the windows for which `holds` is true; overlapping intervals are merged."""
    joined = []
    for row in rows:
        if holds(row):
            begin, end = row["t_s"] - WINDOW_S, row["t_s"]
            if joined and begin <= joined[-1][1]:
                joined[-1][1] = end
            else:
                joined.append([begin, end])
    return joined


def rate_figure(runs, folder, name, title, curves, goals, load_of=None, until=None):
    """Draws rates and triangles. curves: (case, label, colour); goals: (Hz, label); until: case -> last time to draw."""
    figure, (rates, triangles) = start(title, runs.remark, 2)
    disturbed = reused = started = False
    for number, (case, label, colour) in enumerate(curves):
        rows = [r for r in runs.case[case] if r["t_s"] > SETTLE_S and r["t_s"] <= (until or {}).get(case, math.inf)]
        settled = [r for r in rows if Runs.part(r) != "start"]
        began = [r for r in rows if Runs.part(r) == "start"] + settled[:1]
        worst = worst_rows(rows)
        rates.plot([r["t_s"] for r in settled], [r["force_rate_100ms_hz"] for r in settled], color=COLOURS[colour],
                   label=label + worst_label(worst))
        if len(began) > 1:
            started = True
            rates.plot([r["t_s"] for r in began], [r["force_rate_100ms_hz"] for r in began], color=COLOURS[colour], linewidth=0.6)
        rates.plot([r["t_s"] for r in worst.values()], [r["force_rate_100ms_hz"] for r in worst.values()], linestyle="none", marker="v",
                   markersize=7, color=COLOURS[colour], markeredgecolor="white")
        triangles.plot([r["t_s"] for r in rows], [1e-3 * r["triangles"] for r in rows], color=COLOURS[colour])
        strip = {"color": COLOURS[colour], "linewidth": 0}
        for begin, end in spans(rows, lambda r: r["disturbed"]):
            disturbed = True
            rates.axvspan(begin, end, 1.0 - 0.022 * (number + 1), 1.0 - 0.022 * number - 0.004, **strip)
        for begin, end in spans(rows, Runs.reused):
            reused = True
            rates.axvspan(begin, end, 0.022 * number + 0.004, 0.022 * (number + 1), **strip)
    for hz, label in goals:
        rates.axhline(hz, color="#222222", linestyle=":", linewidth=1.4, label=label)
    handles, _ = rates.get_legend_handles_labels()
    if load_of is not None:
        begin, end = runs.load(load_of)
        if begin < end:
            for axes in (rates, triangles):
                axes.axvspan(begin, end, color="#f0ece0", linewidth=0, zorder=0)
            handles.append(Patch(color="#f0ece0", label="external load"))
    if disturbed:
        handles.append(Patch(color="#bbbbbb", label="strip above: disturbed by\nother programs"))
    if reused:
        handles.append(Patch(color="#bbbbbb", label="strip below: work partly reused\n(recomputed fraction below 1)"))
    handles.append(Line2D([], [], color="#777777", marker="v", linestyle="none", label="worst 0.1 s of a part"))
    if started:
        handles.append(Line2D([], [], color="#777777", linewidth=0.6, label="thin: start of the run"))
    rates.set_ylabel("force updates per second (Hz)")
    triangles.set_ylabel("triangles drawn (thousands)")
    triangles.set_xlabel("time (s)")
    for axes in (rates, triangles):
        axes.set_ylim(bottom=0)
        axes.set_ylim(top=1.1 * axes.get_ylim()[1])  # room for the strips
        axes.margins(x=0.01)
    legend(rates, handles)
    save(figure, folder, name)


def draw_rates(folder):
    runs = Runs(folder)
    if "low" in runs.case and "high" in runs.case:
        rate_figure(runs, folder, "fig5_rates.png", "Figure 5: force rate without external load",
                    [("off", "C: no adaptation\n(paper: about 550 Hz)", 0), ("low", f"B: goal {runs.goal('low'):.0f} Hz\n(paper: 800 Hz, held)", 1),
                     ("high", f"A: goal {runs.goal('high'):.0f} Hz\n(paper: 1200 Hz, not reached)", 2)],
                    [(runs.goal("low"), "goals of B and A"), (runs.goal("high"), None)],
                    until={"off": min(runs.load("off")[0], runs.end("low"))})
    rate_figure(runs, folder, "fig7_load_without_law.png", "Figure 7: force rate under an external load, no adaptation",
                [("off", "no adaptation\n(paper: falls to 300 to 400 Hz)", 0)], [], load_of="off")
    if "on" in runs.case:
        curves = [("off", "no adaptation", 0), ("on", f"law {runs.law('on')}\n(paper: stays near its goal)", 1)]
        if "on_paper" in runs.case:
            curves.append(("on_paper", "law sensitus, as in the paper", 3))
        rate_figure(runs, folder, "fig8_load_with_law.png", "Figure 8: force rate under an external load, with adaptation", curves,
                    [(runs.goal("on"), f"goal {runs.goal('on'):.0f} Hz")], load_of="on")


# Forces of a burr (drilling: figures 2 to 4).
def methods(row, quantity):
    """Yields (column, label, dashed) for each block size."""
    for column in row:
        if column.startswith(quantity + "_"):
            size = column[len(quantity) + 1:]
            yield column, ("voxel by voxel" if size == "voxels" else f"smallest block {size.replace('R', ' R')}"), size == "voxels"


def burr_panel(axes, rows, radius, quantity, value, include_voxels=True):
    some = [r for r in rows if r["radius_mm"] == radius]
    for number, (column, label, dashed) in enumerate(methods(rows[0], quantity)):
        if dashed and not include_voxels:
            continue
        # Each curve is thinner than the previous one, so that coinciding curves remain visible.
        axes.plot([r["penetration_mm"] / radius for r in some], [value(r, column) for r in some], color=COLOURS[number],
                  linestyle="--" if dashed else "-", linewidth=3.4 - 0.8 * number, label=label)
    axes.margins(x=0.01)


def draw_drilling(folder):
    rows = read_rows(os.path.join(folder, "forces.csv"))
    growth = read_rows(os.path.join(folder, "growth.csv"))
    radii = sorted({r["radius_mm"] for r in rows})
    ends = [radii[0], radii[-1]]

    figure, axes = start("Figure 2a: force against penetration", "elastic force of flat, solid bone; voxels of 0.3 mm; no erosion", len(ends))
    for panel, radius in zip(axes, ends):
        burr_panel(panel, rows, radius, "force_n", lambda r, c: r[c])
        panel.set_ylabel(f"R = {radius:.0f} mm\nforce (N)")
        panel.set_ylim(bottom=0)
        legend(panel)
    axes[-1].set_xlabel("penetration / R")
    save(figure, folder, "fig2a_force.png")

    def error(row, column):
        return 100.0 * (row[column] / row["true_n"] - 1.0) if row["true_n"] > 0.05 else math.nan
    figure, axes = start("Figure 2b: error of the force",
                         "reference: sums over 512 points in each voxel at the surface of the ball; paper: a few percent or below", len(ends))
    for panel, radius in zip(axes, ends):
        burr_panel(panel, rows, radius, "force_n", error, include_voxels=False)
        panel.set_ylabel(f"R = {radius:.0f} mm\nerror (%)")
        legend(panel)
    axes[-1].set_xlabel("penetration / R")
    save(figure, folder, "fig2b_error.png")

    figure, axes = start("Figure 3: time for one force", "one core; minimum of several repetitions", len(radii), height=2.9)
    for panel, radius in zip(axes, radii):
        burr_panel(panel, rows, radius, "us", lambda r, c: r[c])
        panel.axhline(1000.0, color="#222222", linestyle=":", linewidth=1.4, label="1 ms")
        panel.set_yscale("log")
        panel.set_ylabel(f"R = {radius:.0f} mm\ntime (µs)")
        legend(panel)
    axes[-1].set_xlabel("penetration / R")
    save(figure, folder, "fig3_time.png")

    figure, (panel,) = start("Figure 4: time for one force against burr radius",
                             "penetration R / 2; paper: 1 to 6 mm, voxel by voxel above 1 ms from 2 mm on", 1, height=4.6)
    for number, (column, label, dashed) in enumerate(methods(growth[0], "us")):
        panel.plot([r["radius_mm"] for r in growth], [r[column] for r in growth], color=COLOURS[number], marker="o", markersize=4,
                   linestyle="--" if dashed else "-", label=label)
    panel.axhline(1000.0, color="#222222", linestyle=":", linewidth=1.4, label="1 ms")
    panel.set_yscale("log")
    panel.set_ylabel("time (µs)")
    panel.set_xlabel("burr radius R (mm)")
    legend(panel)
    save(figure, folder, "fig4_growth.png")


# Force rates on surfaces (surface: table 1 and figure 3).
def draw_table(folder):
    rows = [r for r in read_rows(os.path.join(folder, "table1.csv")) if r["hand"] == "slow"]
    figure, (rates, times) = start("Table 1: force rate against mesh size", "one core; a point and a ball, moving at 55 mm/s", 2)
    number = 0
    for mode in ("off-tree", "off-brute", "chr"):
        for tool in ("point", "3 mm"):
            some = sorted((r for r in rows if r["mode"] == mode and str(r["tool"]) == tool), key=lambda r: r["triangles"])
            size = [r["triangles"] for r in some]
            style = {"color": COLOURS[number], "marker": "o", "markersize": 4, "linestyle": "-" if mode == "off-tree" else "--",
                     "label": f"{mode}, {'point' if tool == 'point' else 'ball of 3 mm'}"}
            number += 1
            if not some:
                continue
            rates.plot(size, [r["rate_hz"] for r in some], **style)
            if mode != "off-brute":
                times.plot(size, [r["p999_us"] for r in some], **style)
    rates.axhline(1000.0, color="#222222", linestyle=":", linewidth=1.4, label="1 kHz")
    times.axhline(1000.0, color="#222222", linestyle=":", linewidth=1.4, label="1 ms")
    for axes in (rates, times):
        axes.set_xscale("log")
        axes.set_yscale("log")
    rates.set_ylabel("force rate (Hz)")
    times.set_ylabel("time of a step, 99.9th percentile (µs)")
    times.set_xlabel("triangles")
    legend(rates)
    legend(times)
    save(figure, folder, "table1.png")


def draw_filters(folder):
    rows = read_rows(os.path.join(folder, "filters.csv"))
    figure, (axes,) = start("Figure 3: allowed error of the surface against distance from the probe",
                            "full detail within 3 mm; distance: maximum of |dx|, |dy| and |dz|", 1, height=4.6)
    distance = [r["distance_mm"] for r in rows]
    for number, (column, label) in enumerate((("exact_um", "1 - exp(-x²)"), ("bell_um", "bell, as computed"), ("frustums_um", "multiple frustums"))):
        axes.plot(distance, [r[column] for r in rows], color=COLOURS[number], linestyle="--" if number == 0 else "-", label=label, zorder=3 - number)
    axes.set_xlabel("distance from the probe (mm)")
    axes.set_ylabel("allowed error (µm)")
    axes.set_ylim(bottom=0)
    axes.margins(x=0.01)
    legend(axes)
    save(figure, folder, "fig3_filters.png")


# Meshes side by side (docking: figures 3, 4 and 6).
def draw_panels(folder, name):
    with open(os.path.join(folder, name), encoding="utf-8") as f:
        picture = json.load(f)
    images = [mpimg.imread(os.path.join(folder, p["file"])) for p in picture["panels"]]
    height, width = images[0].shape[:2]
    gap, head, foot = 16, 86, 64
    wide, high = len(images) * (width + gap) + gap, head + height + foot
    figure = plt.figure(figsize=(wide / 100.0, high / 100.0))
    figure.text(gap / wide, 1.0 - 30 / high, picture["title"], fontsize=16, va="center")
    figure.text(gap / wide, 1.0 - 60 / high, picture["remark"], fontsize=10.5, va="center", color="#666666")
    for i, (panel, image) in enumerate(zip(picture["panels"], images)):
        left = gap + i * (width + gap)
        axes = figure.add_axes([left / wide, foot / high, width / wide, height / high])
        axes.imshow(image, interpolation="nearest")
        axes.axis("off")
        middle = (left + 0.5 * width) / wide
        figure.text(middle, (foot - 18) / high, panel["title"], fontsize=12, ha="center", va="center")
        figure.text(middle, (foot - 42) / high, panel["remark"], fontsize=9.5, ha="center", va="center", color="#666666")
    figure.savefig(os.path.join(folder, name[:-len(".panels.json")] + ".png"), dpi=100)
    plt.close(figure)
    print(f"  {name[:-len('.panels.json')]}.png")


def draw_fitting(folder):
    """Share of the starts that ended at a right place, one line per structure and one mark per test."""
    with open(os.path.join(folder, "fitting.json"), encoding="utf-8") as f:
        rows = json.load(f)["rows"]
    models = list(dict.fromkeys((r["pair"], r["model"]) for r in rows))
    tests = list(dict.fromkeys(r["test"] for r in rows))
    figure, (axes,) = start("Right places found from random starts", "%d starts each; a place of equal score counts; where nothing is drawn, the test was not run" % rows[0]["starts"], 1,
                            height=0.9 + 0.12 * (len(tests) + 2) * len(models))
    step = 0.8 / len(tests)
    for i, test in enumerate(tests):
        of = {(r["pair"], r["model"]): r for r in rows if r["test"] == test}
        y = [k + step * (i - 0.5 * (len(tests) - 1)) for k, m in enumerate(models) if m in of]
        share = [100 * (of[m]["right"] + of[m]["equal"]) / of[m]["starts"] for m in models if m in of]
        axes.barh(y, share, 0.9 * step, color=COLOURS[i % len(COLOURS)], label=test)
        for at, value in zip(y, share):
            if value == 0:
                axes.text(1, at, "0", fontsize=8, va="center")
    axes.set_yticks(range(len(models)), ["%s\n%s" % (m[1], m[0]) for m in models], fontsize=8)
    axes.set_ylim(len(models) - 0.5, -0.5)
    axes.set_xlim(0, 100)
    axes.set_xlabel("starts that ended at a right place (%)")
    legend(axes)
    save(figure, folder, "fitting.png")


def draw(folder):
    def have(*names):
        return all(os.path.exists(os.path.join(folder, n)) for n in names)
    if have("rates.csv"):
        draw_rates(folder)
    if have("forces.csv", "growth.csv"):
        draw_drilling(folder)
    if have("table1.csv"):
        draw_table(folder)
    if have("filters.csv"):
        draw_filters(folder)
    if have("fitting.json"):
        draw_fitting(folder)
    for name in sorted(os.listdir(folder)):
        if name.endswith(".panels.json"):
            draw_panels(folder, name)


def self_test():
    """Draws each kind of figure from a few rows, including gaps, a single run, and values that are not numbers."""
    def write(folder, name, header, rows):
        with open(os.path.join(folder, name), "w", encoding="utf-8", newline="") as f:
            writer = csv.writer(f)
            writer.writerow(header.split(","))
            writer.writerows(rows)
    with tempfile.TemporaryDirectory() as folder:
        # The worst window with load is right after the start of the load; without load, at 5.2 s. The start is excluded.
        def rate(i, with_load):
            return 100 if i < 40 else 700 if i == 260 else (450 if i < 420 else 600) if with_load and i > 400 else 900

        def part(i, with_load):
            return "load" if with_load and i > 400 else "start" if i < 100 else "no_load"
        header = "run,case,goal_hz,t_s,external_load,force_rate_100ms_hz,step_work_done_anew,disturbed,triangles,part"
        rows = [[f"{case}, x", case, goal, 0.02 * i, int(with_load and i > 400), rate(i, with_load), 1.0 if i % 70 < 40 else 0.5,
                 int(i % 50 < 3), 5000 + i, part(i, with_load)]
                for case, goal, with_load in (("off", 0, True), ("low", 800, False), ("high", 1200, False), ("on", 900, True))
                for i in range(800 if with_load else 400)]
        write(folder, "rates.csv", header, rows)
        header = "radius_mm,penetration_mm,true_n,force_n_0.1R,force_n_voxels,us_0.1R,us_voxels"
        write(folder, "forces.csv", header, [[r, r * i / 20, 0.1 * i, 0.1 * i, 0.101 * i, 2 + i, 90 + i] for r in (1, 5) for i in range(20)])
        write(folder, "growth.csv", header, [[r, r / 2, 1, 1, 1, 2 * r, 90 * r * r] for r in (1, 2, 6)])
        write(folder, "table1.csv", "triangles,tool,mode,hand,rate_hz,p999_us",
              [[n, tool, mode, "slow", 1e6 / n, n / 50] for n in (2000, 92450) for tool in ("point", "3 mm") for mode in ("off-tree", "chr")])
        write(folder, "filters.csv", "distance_mm,exact_um,bell_um,frustums_um", [[i, i, i, i] for i in range(9)])
        with open(os.path.join(folder, "fitting.json"), "w", encoding="utf-8") as f:
            json.dump({"rows": [{"pair": "map", "model": m, "test": t, "starts": 20, "right": 18, "equal": 1}
                                for m in ("a", "b") for t in ("search alone", "together") if (m, t) != ("b", "together")]}, f)
        plt.imsave(os.path.join(folder, "a.png"), [[0.0, 1.0], [1.0, 0.0]])
        with open(os.path.join(folder, "fig3_border.panels.json"), "w", encoding="utf-8") as f:
            json.dump({"title": "t", "remark": "r", "panels": [{"file": "a.png", "title": "(a)", "remark": ""}] * 2}, f)
        draw(folder)
        wanted = ["fig5_rates", "fig7_load_without_law", "fig8_load_with_law", "fig2a_force", "fig2b_error", "fig3_time", "fig4_growth", "table1",
                  "fig3_filters", "fig3_border", "fitting"]
        worst = worst_rows([r for r in Runs(folder).case["on"] if r["t_s"] > SETTLE_S])
        rates = {part: row["force_rate_100ms_hz"] for part, row in worst.items()}
        if rates != {"no_load": 700.0, "load": 450.0}:
            print(f"FAIL wrong worst windows: {rates}")
            return 1
        missing = [n for n in wanted if not os.path.exists(os.path.join(folder, n + ".png"))]
        for name in missing:
            print(f"FAIL missing figure: {name}.png")
        return 1 if missing else 0


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 1
    if sys.argv[1] == "--self-test":
        return self_test()
    draw(sys.argv[1])
    return 0


if __name__ == "__main__":
    sys.exit(main())
