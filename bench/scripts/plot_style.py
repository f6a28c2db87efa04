"""Styles and helpers that the figures and tables of all studies share."""
import textwrap

# Colours of Okabe and Ito, which colour-blind readers can tell apart. A method has the same colour in float and double.
# A quadrature rule has the same colour on the CPU and with Vulkan.
STYLES = {
    "midpoint": ("midpoint", "#E69F00", "s", "-"),
    "gauss": ("Gauss", "#009E73", "D", "-"),
    "vulkan-midpoint": ("midpoint, Vulkan", "#E69F00", "s", "--"),
    "vulkan-gauss": ("Gauss, Vulkan", "#009E73", "D", "--"),
    "monte-carlo": ("Monte Carlo", "#56B4E9", "v", "-"),
    "hcubature": ("hcubature", "#CC79A7", "^", "-"),
    "pcubature": ("pcubature", "#CC79A7", "^", "--"),
    "dblquad": ("SciPy", "#555555", "X", "-"),
    "vulkan-float": ("Vulkan float", "#0072B2", "o", "-"),
    "vulkan-double": ("Vulkan double", "#0072B2", "o", "--"),
    "cpu-float": ("CPU float", "#D55E00", "p", "-"),
    "cpu-double": ("CPU double", "#D55E00", "p", "--"),
}
OTHER_STYLE = ("#000000", "*", ":")
MASKINGS = {"none": "#009E73", "v-cavity": "#E69F00", "integral": "#0072B2", "smith": "#CC79A7"}
NOTE_WIDTH = 150  # letters


def style(method):
    return STYLES.get(method, (method, *OTHER_STYLE))


def time_text(time_s):
    for factor, unit in ((1e9, "ns"), (1e6, "µs"), (1e3, "ms"), (1, "s")):
        if time_s * factor < 999.5 or unit == "s":
            value = time_s * factor
            return f"{value:.0f} {unit}" if value >= 99.5 else f"{value:.2g} {unit}"
    raise AssertionError


def digits(value):
    """A number rounded to three significant digits, with commas between thousands."""
    return f"{float(f'{value:.3g}'):,.0f}" if value >= 100 else f"{value:.3g}"


def row_of_cells(cells):
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def head(cells):
    """The first two lines of a Markdown table."""
    return [row_of_cells(cells), "|---" * len(cells) + "|"]


def tidy(axes, grid="x"):
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.tick_params(labelsize=8)
    axes.grid(True, axis=grid, color="#DDDDDD", linewidth=0.6)
    axes.set_axisbelow(True)


def origin(result):
    """Machine and date, for the foot of a figure."""
    context = result["context"]
    device = context["device"].get("name", "no Vulkan device")
    return f"{context['machine']['processor']}, {context['machine']['cores']} cores; {device}; {context['date'][:10]}"


def foot(drawing, text):
    drawing.text(0.01, 0.008, "\n".join(textwrap.wrap(text, NOTE_WIDTH)), fontsize=7.5, color="#444444")
