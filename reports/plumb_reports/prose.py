"""A case's README.md as HTML, formulas included, without anything loaded from elsewhere."""

import html
import io
import re

import markdown
from matplotlib import mathtext
from matplotlib.font_manager import FontProperties

from .figure_style import styled

FORMULA = re.compile(r"\$\$(?P<block>.+?)\$\$|(?<![\\$\w])\$(?P<inline>(?!\s)[^$]+?(?<!\s))\$(?!\w)", re.DOTALL)
CODE = re.compile(r"(```.*?```|`[^`\n]*`|(?:(?<=\n\n)|\A)(?:(?: {4}|\t)[^\n]*\n?)+)", re.DOTALL)
POINTS = {"formula": 11, "formula block": 14}


def html_of_markdown(text):
    """HTML of a Markdown text with tables, fenced code and $formulas$."""
    formulas = []

    def stored(match):
        formulas.append(formula_html(match))
        return f"FORMULA{len(formulas) - 1}END"

    parts = CODE.split(text)  # every second part is code, in which $ means $
    parts[0::2] = [FORMULA.sub(stored, part) for part in parts[0::2]]
    made = markdown.markdown("".join(parts), extensions=["tables", "fenced_code", "sane_lists"])
    return re.sub(r"FORMULA(\d+)END", lambda match: formulas[int(match[1])], made)


def formula_html(match):
    """One formula as inline SVG; as code when matplotlib's mathtext does not know a command in it."""
    kind = "formula block" if match["block"] is not None else "formula"
    source = " ".join((match["block"] or match["inline"]).split())
    try:
        drawing, depth = formula_svg(source, POINTS[kind])
    except (ValueError, RuntimeError):
        return f"<code>{html.escape(source)}</code>"
    return (f'<span class="{kind}" role="img" aria-label="{html.escape(source)}" '
            f'style="vertical-align:{-depth:.1f}pt">{drawing}</span>')


def formula_svg(source, points):
    """(SVG text in the colour of its surroundings, depth below the baseline in points)."""
    buffer = io.BytesIO()
    font = FontProperties(size=points, math_fontfamily="dejavuserif")
    depth = styled(mathtext.math_to_image, f"${source}$", buffer, font, 72, "svg")
    drawing = buffer.getvalue().decode("utf-8")
    drawing = drawing[drawing.index("<svg"):]
    drawing = re.sub(r"<metadata>.*?</metadata>", "", drawing, flags=re.DOTALL)
    drawing = re.sub(r'(?s)<g id="patch_1">.*?</g>', "", drawing, count=1)  # the white background
    return drawing.replace("<svg", '<svg fill="currentColor"', 1), depth
