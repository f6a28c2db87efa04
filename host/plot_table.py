#!/usr/bin/env python3
"""Draws a lookup table: DOLP against theta for several sigma, and a map over theta and sigma if both have many values.

Usage: plot_table.py TABLE.nc OUT.png [--q Q] [--wavelength UM] [--temperature K] [--n N] [--k K] [--material NAME] [--band FROM-TO]
                     [--theta DEG] [--sigma SIGMA] [--view_zenith_deg DEG] [--relative_azimuth_deg DEG]
       plot_table.py TABLE.nc OUT.png --rank THETA ...   ranks the materials of a table by DOLP at this zenith
A bistatic table may have more view zeniths than thetas, or more relative azimuths than sigmas. Then view zenith replaces
theta, or azimuth replaces sigma. Of each other axis the picture shows one value. An option such as --q Q chooses the
value nearest to Q. Without an option the picture shows the first band, and of other axes the value nearest to the
scene's value (the middle value if it has none). One curve has the scene's sigma. In a table of wind speeds, wind
replaces sigma. If a table has several materials and you choose none, each curve shows one material, with the scene's
sigma.
Entries with nonzero status are faint or hatched. Needs python3-netcdf4, python3-numpy and python3-matplotlib.
Exit status: 0 done, 2 usage or a file that is not such a table, 4 the picture could not be written.
"""
import argparse
import re
import sys
import textwrap
import tomllib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend has to be chosen first)
import netCDF4  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402
from matplotlib.patches import Patch  # noqa: E402
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter  # noqa: E402

sys.dont_write_bytecode = True  # writes no cache folder beside the scripts
import picture_file  # noqa: E402

COLOURS = "viridis"
MOST_CURVES = 6
CONTOURS_PERCENT = (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50)
FAR_BEYOND = 2  # a curve that rises to more than FAR_BEYOND times the scale, at its end, leaves the axis
SHOWN_SHARE_PERCENT = 97  # share of the entries that fit on the DOLP scale; a few much larger values may not fit
FEW_ANGLES = 25  # a curve of at most this many zeniths has a dot at each entry
# Least number of values on each of the two axes of a map. A smaller map would suggest structure that the table lacks.
FEWEST_OF_MAP = 6
SMALLEST_SPAN_PERCENT = 0.01  # least range of the DOLP axis, so that rounding noise does not look like a signal
ABOVE = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "borderaxespad": 0.3, "frameon": False, "fontsize": 9}
STATUS_MEANINGS = {
    1: r"$\rho_s$ or $\rho_p$ outside [0, 1]",
    2: "tolerance not met",
    4: "outside the domain",
    8: r"$I \leq 0$",
    32: "single scattering is not enough",
}
QUOTES = "'\""  # of a text in TOML
RHO_TOLERANCE_NOT_MET = 16
MODEL_INACCURATE = 32  # the numbers are right for the model


# The numeric axes with their symbols. The picture shows one value of each axis that it is not drawn over.
SYMBOLS = {"q": "q", "wavelength": "λ", "temperature": "T", "n": "n", "k": "k", "theta": r"$\theta$", "sigma": r"$\sigma$",
           "view_zenith_deg": r"$\theta_v$", "relative_azimuth_deg": r"$\Delta\phi$", "sigma_cross": r"$\sigma_c$",
           "surface_azimuth_deg": r"$\phi_w$"}
ACROSS = {"theta": r"zenith angle $\theta$ (degree)", "view_zenith_deg": r"zenith of the view $\theta_v$ (degree)"}
UPWARDS = {"sigma": r"roughness $\sigma$", "relative_azimuth_deg": r"relative azimuth $\Delta\phi$ (degree)",
           "surface_azimuth_deg": r"azimuth of the surface $\phi_w$ (degree)"}
NAMED = ("material", "band")  # axes whose values are names; the picture shows one of the names
DEFAULTS = {"material": "one curve for each", "band": "the first"}
UNITS = {"wavelength": " µm", "temperature": " K", "band": " µm", "theta": "°", "view_zenith_deg": "°", "relative_azimuth_deg": "°",
         "surface_azimuth_deg": "°"}
KEYS = {"temperature": ("emission", "temperature_K"), "q": ("surface", "q"), "n": ("surface", "n"), "k": ("surface", "k"),
        "wavelength": ("spectrum", "wavelength_um"),
        "sigma": ("surface", "sigma"), "wind_m_s": ("surface", "wind_m_s"), "view_zenith_deg": ("geometry", "view_zenith_deg"),
        "relative_azimuth_deg": ("geometry", "relative_azimuth_deg"), "sigma_cross": ("surface", "sigma_cross"),
        "surface_azimuth_deg": ("geometry", "surface_azimuth_deg")}  # the scene's key for each axis


def text_of(dataset, name):
    """A text attribute of a table. A table stores a long text as a variable of characters instead."""
    return dataset[name][:].tobytes().decode() if name in dataset.variables else getattr(dataset, name, "")


def names_of(dataset, axis):
    """The names along an axis of NAMED. Tables of dolp 0.2 have them in a variable with the name of the axis."""
    if axis in dataset.variables:
        return [str(name) for name in dataset[axis][:]]
    if axis == "material":
        return [str(name) for name in dataset["material_name"][:]]
    limits = (np.asarray(dataset[name][:]) for name in ("band_low", "band_high"))
    return ["-".join(np.format_float_positional(end, trim="-") for end in band) for band in zip(*limits)]


def scene_part(dataset, part):
    """Keys of the TOML table `part` of the scene, with the overrides. Empty if the text of the scene is not TOML."""
    try:
        keys = tomllib.loads(text_of(dataset, "scene")).get(part, {})
        for line in text_of(dataset, "scene_overrides").splitlines():
            is_shown = not line.startswith("spectrum.response_per")
            if line.startswith(f"{part}.") and is_shown:
                kept = {} if part == "spectrum" else keys  # has one key: a wavelength, a band or a response
                keys = {**kept, **tomllib.loads(line.removeprefix(f"{part}."))}
        return keys
    except ValueError:
        return {}


def spectrum_of(dataset):
    """The wavelength, band or response of the scene as text. Empty if the table has an axis of wavelengths or bands."""
    has_axis = "wavelength" in dataset.dimensions or "band" in dataset.dimensions
    spectrum = {} if has_axis else scene_part(dataset, "spectrum")
    if "response_file" in spectrum:
        return "response of " + spectrum["response_file"].rsplit("/", 1)[-1]
    return "–".join(f"{end:g}" for end in np.ravel(list(spectrum.values()))) + " µm" if spectrum else ""


def index_in_scene(dataset, axis):
    """Position of the axis value nearest to the scene's value; the middle position if the scene has none."""
    part, key = KEYS.get(axis, ("", ""))
    own = scene_part(dataset, part).get(key)
    along = np.asarray(dataset[axis][:])
    return int(np.argmin(np.abs(along - own))) if isinstance(own, (int, float)) else len(along) // 2


def title_of(dataset):
    """The scene's title without its spectrum. If the table has a wind axis, the wind speed is removed, too."""
    title = re.sub(r"[, ]*[\d.]+( *[-–] *[\d.]+)? *[uµ]m$", "", text_of(dataset, "title"))
    return re.sub(r"[, ]*wind [\d.]+ m/s", "", title) if "wind_m_s" in dataset.variables else title


def scene_changes(dataset):
    """The settings that changed the scene after its title was written, as text. The picture shows the others itself."""
    changed = dict(line.split("=", 1) for line in text_of(dataset, "scene_overrides").splitlines() if "=" in line)
    return ", ".join(f"{key} = {value.strip(QUOTES)}" for key, value in changed.items()
                     if key != "title" and not key.startswith(("grid.", "spectrum.", "accuracy.")))


class NotATable(Exception):
    """The file is not a table of dolp, or lacks a requested axis."""


def position_of(dataset, axis, name):
    """Position of a material or band on its axis. `name`: its name, or a part that no other name contains."""
    names = names_of(dataset, axis)
    alike = [i for i, own in enumerate(names) if name.lower() in own.lower()]
    same = [i for i in alike if names[i].lower() == name.lower()]
    if len(same or alike) != 1:
        raise NotATable(f"has no {axis} {name!r}; it has {', '.join(names)}")
    return (same or alike)[0]


def drawn_axis(dataset, labels, wanted):
    """The axis among `labels` with the most values, of those for which no value is wanted."""
    axes = [axis for axis in labels if axis in dataset["dolp"].dimensions and wanted[axis] is None]
    if not axes:
        raise NotATable(f"needs one of the axes {', '.join(labels)} without a chosen value")
    return max(axes, key=lambda axis: dataset.dimensions[axis].size)


class Slice:
    """A table's entries over two axes, at one value of each other axis. The first, `x`, is a zenith. The second, `y`, is
    sigma, the wind speed or the relative azimuth. Both are sorted, and DOLP is in percent."""

    def __init__(self, dataset, wanted):
        """`wanted`: a value for each axis in SYMBOLS and NAMED. If it is None, the scene's value or the first name."""
        for name in ("theta", "sigma", "q", "dolp"):
            if name not in dataset.variables:
                raise NotATable(f"has no variable {name}; a table with DOLP is expected")
        axes = dataset["dolp"].dimensions
        across, self.upwards = (drawn_axis(dataset, labels, wanted) for labels in (ACROSS, UPWARDS))
        at = {}
        self.replaced = []
        for axis, value in wanted.items():
            if axis in (across, self.upwards):
                continue
            if axis in axes and axis in NAMED:
                at[axis] = 0 if value is None else position_of(dataset, axis, value)
            elif axis in axes:
                along = np.asarray(dataset[axis][:])
                at[axis] = index_in_scene(dataset, axis) if value is None else int(np.argmin(np.abs(along - value)))
                if value is not None and not np.isclose(along[at[axis]], value):
                    self.replaced.append(f"has no {axis} = {value:g}; the nearest, {along[at[axis]]:g}, is drawn")
            elif value is not None:
                raise NotATable(f"has no axis {axis}; its axes are {', '.join(axes)}")
        self.at = at
        place = tuple(at.get(axis, slice(None)) for axis in axes)
        self.has_winds = self.upwards == "sigma" and "wind_m_s" in dataset.variables
        upwards = "wind_m_s" if self.has_winds else self.upwards
        x, y = np.asarray(dataset[across][:]), np.asarray(dataset[upwards][:])
        rows, columns = np.argsort(x), np.argsort(y)
        self.x, self.y = x[rows], y[columns]
        self.column_in_scene = int(np.flatnonzero(columns == index_in_scene(dataset, upwards))[0])
        self.material = names_of(dataset, "material")[at["material"]] if "material" in at else None
        self.place = ", ".join(f"{names_of(dataset, axis)[i]}{UNITS.get(axis, '')}" if axis in NAMED else
                               f"{SYMBOLS[axis]} = {dataset[axis][i]:g}{UNITS.get(axis, '')}"
                               for axis, i in at.items() if axis != "material")

        def values(name, fill):
            data = np.ma.filled(dataset[name][place], fill)
            return (data if axes.index(across) < axes.index(self.upwards) else data.T)[np.ix_(rows, columns)]

        self.dolp = 100.0 * values("dolp", np.nan)
        if "stokes_i" in dataset.variables:  # where I is NaN, at 90 degrees, DOLP is a limit; not drawn
            self.dolp[np.isnan(values("stokes_i", np.nan))] = np.nan
        status = values("status", 0) if "status" in dataset.variables else np.zeros(self.dolp.shape, int)
        self.status = status & ~RHO_TOLERANCE_NOT_MET  # the picture shows DOLP, not rho
        has_bracket = "dolp_low" in dataset.variables and "dolp_high" in dataset.variables
        self.bracket = [100.0 * values(name, np.nan) for name in ("dolp_low", "dolp_high")] if has_bracket else None
        errors = values("error_estimate", np.nan) if "error_estimate" in dataset.variables else None
        self.worst_error = self._worst(errors) if errors is not None else None
        self.title, self.spectrum, self.changes = title_of(dataset), spectrum_of(dataset), scene_changes(dataset)
        is_bistatic = "stokes_i" in dataset.variables and "sr-1" in dataset["stokes_i"].units
        is_source = is_bistatic and across == "theta"
        self.zenith = r"zenith of the source $\theta$ (degree)" if is_source else ACROSS[across]
        self.is_map = min(self.x.size, self.y.size) >= FEWEST_OF_MAP

    def name_of(self, y):
        return f"wind {y:.3g} m/s" if self.has_winds else f"{SYMBOLS[self.upwards]} = {y:.3g}{UNITS.get(self.upwards, '')}"

    def heading(self, subject=None):
        """The title of a picture. `subject`: what the picture shows instead of the material of the scene."""
        title = f"{subject} in “{self.title}”" if subject and self.title else subject or self.title
        first = ", ".join(part for part in (title, self.spectrum) if part)
        return first + (f"\nwith {self.changes}" if self.changes else "")

    def _worst(self, errors):
        promised = errors[((self.status & (1 | 4 | 8)) == 0) & np.isfinite(errors)]
        return promised.max() if promised.size else None

    def largest(self, allowed=0):
        """Upper end of the DOLP scale. SHOWN_SHARE_PERCENT of the entries lie below it that have no status bits other
        than `allowed`."""
        trusted = self.dolp[((self.status & ~allowed) == 0) & np.isfinite(self.dolp)]
        shown = trusted if trusted.size else self.dolp[np.isfinite(self.dolp)]
        return max(np.percentile(shown, SHOWN_SHARE_PERCENT), SMALLEST_SPAN_PERCENT) if shown.size else 1.0

    def caption(self):
        parts = [f"{self.x.size} × {self.y.size} entries at {self.place}"]
        if self.worst_error is not None:
            parts.append(f"worst error estimate of DOLP {100.0 * self.worst_error:.2g} points")
        flagged = int(np.count_nonzero(self.status))
        if flagged:
            bits = [text for bit, text in STATUS_MEANINGS.items() if np.any(self.status & bit)]
            parts.append(f"{flagged} with a status: " + ", ".join(bits))
        return "; ".join(parts)


def cell_edges(centres):
    """Edges of the cells of a map: the first value of the axis, the midpoints between its values, the last value."""
    middle = 0.5 * (centres[1:] + centres[:-1])
    return np.concatenate([[centres[0]], middle, [centres[-1]]])


def highest_peak(curve):
    """The largest local maximum of the curve; 0 if there is none."""
    known = curve[np.isfinite(curve)]
    is_peak = (known[1:-1] > known[:-2]) & (known[1:-1] >= known[2:])
    return max(known[1:-1][is_peak], default=0.0)


def drawn_columns(table):
    """Positions of the values of y to draw: at most MOST_CURVES, evenly spread. The scene's value replaces the nearest."""
    chosen = np.linspace(0, table.y.size - 1, min(MOST_CURVES, table.y.size)).round().astype(int)
    chosen[np.argmin(np.abs(chosen - table.column_in_scene))] = table.column_in_scene
    return chosen


def table_curves(table):
    """The curves of a table: for each drawn value of y the table, its position, and the name of the curve."""
    return [(table, j, table.name_of(table.y[j])) for j in drawn_columns(table)]


def draw_curves(axes, curves):
    """`curves`: tuples of a table, the position of a value of y, and a name."""
    colours = matplotlib.colormaps[COLOURS](np.linspace(0.0, 0.88, len(curves)))
    scale = max(table.largest(MODEL_INACCURATE) for table, _, _ in curves)
    highest = [scale]
    for colour, (table, j, name) in zip(colours, curves):
        good = np.where(table.status[:, j] == 0, table.dolp[:, j], np.nan)
        style = {"color": colour, "marker": "o" if table.x.size <= FEW_ANGLES else None, "markersize": 3.5}
        axes.plot(table.x, table.dolp[:, j], alpha=0.35, linewidth=1.2, linestyle="--", **style)
        if table.bracket:
            low, high = (end[:, j] for end in table.bracket)
            axes.fill_between(table.x, low, high, color=colour, alpha=0.12, linewidth=0.0)
            highest += list(high[np.isfinite(high)])
        right = table.dolp[(table.status[:, j] & ~MODEL_INACCURATE) == 0, j]
        end = np.nanmax(right, initial=0.0)
        highest.append(end if end < FAR_BEYOND * scale else highest_peak(good))
        axes.plot(table.x, good, linewidth=1.8, label=name, **style)
    axes.set_ylim(0.0, 1.08 * max(highest))
    axes.set_ylabel("DOLP (%)")
    axes.grid(alpha=0.25, linewidth=0.6)
    handles, _ = axes.get_legend_handles_labels()
    has_bracket = any(table.bracket for table, _, _ in curves)
    if has_bracket:
        handles.append(Patch(color="0.4", alpha=0.25, linewidth=0.0, label="all bounces lie between"))
    if any(np.any(table.status[:, j]) for table, j, _ in curves):
        handles.append(Line2D([], [], color="0.4", alpha=0.6, linestyle="--", linewidth=1.2, label="status $\\neq$ 0"))
    axes.legend(handles=handles, ncols=2, **ABOVE)


def draw_flags(axes, table):
    flagged = np.ma.masked_equal((table.status != 0).astype(float), 0.0)
    if flagged.count() == 0:
        return
    grid = np.meshgrid(cell_edges(table.x), cell_edges(table.y), indexing="ij")
    grey = matplotlib.colors.ListedColormap(["0.72"])
    axes.pcolor(*grid, flagged, cmap=grey, hatch="////", edgecolor="0.55", linewidth=0)
    patch = Patch(facecolor="0.72", edgecolor="0.55", hatch="////", label="status $\\neq$ 0")
    axes.legend(handles=[patch], **ABOVE)


def draw_contours(axes, table):
    shown = np.ma.masked_where((table.status != 0) | ~np.isfinite(table.dolp), table.dolp)
    if shown.count() == 0 or shown.max() - shown.min() < SMALLEST_SPAN_PERCENT:
        return
    levels = [level for level in CONTOURS_PERCENT if shown.min() < level < table.largest()]
    if not levels:
        return
    lines = axes.contour(table.x, table.y, shown.T, levels=levels, colors="white", linewidths=0.8)
    axes.clabel(lines, fontsize=8, fmt=lambda level: f"{level:g}%")


def draw_map(figure, axes, table):
    shown = np.ma.masked_where((table.status != 0) | ~np.isfinite(table.dolp), table.dolp)
    edges = cell_edges(table.x), cell_edges(table.y)
    mesh = axes.pcolormesh(*edges, shown.T, cmap=COLOURS, vmin=0.0, vmax=table.largest(), rasterized=True)
    beyond = shown.count() > 0 and shown.max() > table.largest()
    figure.colorbar(mesh, ax=axes, pad=0.02, extend="max" if beyond else "neither").set_label("DOLP (%)")
    draw_contours(axes, table)
    draw_flags(axes, table)
    ratio = table.y[-1] / table.y[0] if table.y[0] > 0.0 else 1.0
    if ratio > 8.0 and table.upwards == "sigma":
        axes.set_yscale("log")
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.yaxis.set_major_formatter(FormatStrFormatter("%g"))
        axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_ylabel("wind (m/s)" if table.has_winds else UPWARDS[table.upwards])


def draw(table, path):
    """Draws curves and, if both axes have many values, a map."""
    width = 11.5 if table.is_map else 7.0
    figure, panels = new_figure(width, 1 + table.is_map)
    draw_curves(panels[0], table_curves(table))
    if table.is_map:
        draw_map(figure, panels[1], table)
    finish(figure, panels, table, table.heading(table.material), table.caption())
    picture_file.save(figure, path)


def draw_materials(tables, path):
    """Draws a curve for each of the first MOST_CURVES materials. `tables`: the slice of each material."""
    names = list(tables)[:MOST_CURVES]
    first = tables[names[0]]
    figure, panels = new_figure(7.0, 1)
    draw_curves(panels[0], [(tables[name], tables[name].column_in_scene, name) for name in names])
    some = f"The first {len(names)} of " if len(names) < len(tables) else ""
    advice = "--material NAME draws one of them, --rank THETA ranks all"
    finish(figure, panels, first, first.heading(f"{some}{len(tables)} materials"),
           f"{first.name_of(first.y[first.column_in_scene])}, {first.place}; {advice}")
    picture_file.save(figure, path)


def new_figure(width, count):
    plt.rcParams.update({"font.size": 10.5, "hatch.linewidth": 0.6})
    plt.rcParams.update({"axes.spines.top": False, "axes.spines.right": False})
    figure, panels = plt.subplots(1, count, figsize=(width, 5.4), dpi=150, layout="constrained", squeeze=False)
    return figure, panels[0]


def finish(figure, panels, table, heading, caption):
    for axes in panels:
        axes.set_xlabel(table.zenith)
        if table.x.size > 1:
            axes.set_xlim(table.x[0], table.x[-1])
    set_heading(figure, heading)
    figure.supxlabel(textwrap.fill(caption, int(14 * figure.get_figwidth())), fontsize=9, color="0.3")


def set_heading(figure, heading):
    """Sets the title. Breaks its lines where they would be wider than the figure."""
    lines = [textwrap.fill(line, int(9 * figure.get_figwidth())) for line in heading.split("\n")]
    figure.suptitle("\n".join(lines), fontsize=12)


def draw_ranking(tables, theta, path):
    """Draws for each material a bar (DOLP with the scene's sigma) and a line (range of DOLP over all sigma)."""
    first = next(iter(tables.values()))
    row = int(np.argmin(np.abs(first.x - theta)))
    own = {name: table.dolp[row, table.column_in_scene] for name, table in tables.items()}
    names = sorted(tables, key=lambda name: np.nan_to_num(own[name]))
    figure, axes = plt.subplots(figsize=(7.5, 1.4 + 0.22 * len(names)), dpi=150, layout="constrained")
    faint = [tables[name].status[row, tables[name].column_in_scene] != 0 for name in names]
    bars = axes.barh(names, [own[name] for name in names], color=matplotlib.colormaps[COLOURS](0.45), height=0.7)
    for bar, is_faint in zip(bars, faint):
        bar.set_alpha(0.4 if is_faint else 1.0)
    if first.y.size > 1:
        ends = [(np.nanmin(tables[name].dolp[row]), np.nanmax(tables[name].dolp[row])) for name in names]
        axes.hlines(names, *zip(*ends), color="0.25", linewidth=1.0,
                    label=f"{first.name_of(first.y[0])} to {first.y[-1]:.3g}")
    if any(faint):
        axes.barh(names[:1], [0.0], color="0.5", alpha=0.4, label=r"status $\neq$ 0")
    if axes.get_legend_handles_labels()[0]:
        axes.legend(frameon=False, fontsize=9, loc="lower right")
    axes.set_xlabel(f"DOLP (%) at {first.x[row]:g}° with {first.name_of(first.y[first.column_in_scene])}, "
                    f"{first.place}")
    axes.set_xlim(left=0.0)
    axes.margins(y=0.01)
    axes.tick_params(axis="y", labelsize=8.5)
    axes.grid(axis="x", alpha=0.25, linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)
    set_heading(figure, first.heading(f"{len(names)} materials"))
    picture_file.save(figure, path)


def finite(text):
    """Reads a finite number. Messages of argparse contain the name of this function, as in "invalid finite value"."""
    number = float(text)
    if not np.isfinite(number):
        raise ValueError
    return number


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("table")
    parser.add_argument("picture")
    for axis in SYMBOLS:
        parser.add_argument(f"--{axis}", type=finite, help="draw the value nearest to it; default: the scene's value")
    for axis in NAMED:
        parser.add_argument(f"--{axis}", help=f"draw this {axis}; default: {DEFAULTS[axis]}")
    parser.add_argument("--rank", type=finite, metavar="THETA", help="rank the materials at this zenith")
    arguments = parser.parse_args()
    wanted = {axis: getattr(arguments, axis) for axis in (*SYMBOLS, *NAMED)}
    try:
        with netCDF4.Dataset(arguments.table) as dataset:
            table = Slice(dataset, wanted)
            if arguments.rank is not None and "material" not in table.at:
                raise NotATable("has no axis of materials to rank; give grid.material in the scene")
            has_choice = arguments.rank is None and arguments.material is not None
            names = [] if has_choice or "material" not in table.at else names_of(dataset, "material")
            materials = {name: Slice(dataset, {**wanted, "material": name}) for name in names}
    except (OSError, NotATable) as error:
        print(f"{arguments.table}: {error}", file=sys.stderr)
        return 2
    for text in table.replaced:
        print(f"{arguments.table}: {text}", file=sys.stderr)
    try:
        if arguments.rank is not None:
            draw_ranking(materials, arguments.rank, arguments.picture)
        elif len(materials) > 1:
            draw_materials(materials, arguments.picture)
        else:
            draw(table, arguments.picture)
    except OSError as error:
        print(f"{arguments.picture}: {error}", file=sys.stderr)
        return 4
    return 0


if __name__ == "__main__":
    sys.exit(main())
