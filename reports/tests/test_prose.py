"""README.md as HTML."""

from plumb_reports.prose import html_of_markdown


def test_markdown():
    made = html_of_markdown("# Title\n\n| a | b |\n|---|---|\n| 1 | 2 |\n\n```\ncost = $5 + $6\n```\n")
    assert "<h1>Title</h1>" in made and "<table>" in made and "cost = $5 + $6" in made


def test_formulas_are_drawn():
    made = html_of_markdown(r"With $\tau_p = \rho d^2 / (18 \mu)$ and" + "\n\n" + r"$$u = \frac{a}{b}$$")
    assert made.count("<svg") == 2 and 'class="formula block"' in made and "currentColor" in made


def test_unknown_commands_are_shown_as_code():
    assert r"<code>\unknowncommand{x}</code>" in html_of_markdown(r"$\unknowncommand{x}$")


def test_prices_are_no_formulas():
    assert "<svg" not in html_of_markdown("from $5 to $6 in `$x$`")


def test_indented_code_keeps_its_dollars():
    assert "$a$" in html_of_markdown("text\n\n    code $a$\n\ntext")
