"""Tables of results, such as means per arm, in formats for papers, web pages and terminals."""

from __future__ import annotations

from dataclasses import dataclass, replace
from html import escape
from math import floor, isfinite, log10
from typing import TYPE_CHECKING, Any, Literal, cast

import pandas as pd

from rmfs.errors import InputError
from rmfs.experiments.extras import optional
from rmfs.experiments.statistics import against, per_arm
from rmfs.experiments.wording import heading, p_value
from rmfs.files import write_text
from rmfs.measure.dictionary import FOOTPRINT

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from rmfs.experiments.statistics.intervals import Method

Format = Literal["latex", "markdown", "csv", "html"]

SUFFIXES: dict[str, Format] = {
    ".tex": "latex",
    ".md": "markdown",
    ".csv": "csv",
    ".html": "html",
}

COLUMNS = ("units_per_h", "orders_per_h", "units_per_visit", "distance_per_unit_m")
"""Columns shown by default."""

ROUNDING = 1e-12
"""Absolute value below which a number counts as 0."""

HALF = "±"
UNITS = {column.name: column.unit for column in FOOTPRINT}


@dataclass(frozen=True, repr=False)
class Table:
    """A table of numbers that can be written in several formats.

    Attributes
    ----------
    frame
        Values in full precision; the columns are pairs of measure and statistic.
    decimals
        Number of decimal places per column.
    caption
        The caption: one sentence, and a note if there is one.
    """

    frame: pd.DataFrame
    decimals: Mapping[tuple[str, str], int]
    caption: str

    def __repr__(self) -> str:
        return f"{self._shown().to_string()}\n{self.caption}"

    def _repr_html_(self) -> str:
        return self.html()

    def noted(self, note: str) -> Table:
        """Return the table with a note added to its caption; unchanged if the note is empty."""
        return replace(self, caption=f"{self.caption} Note: {note}.") if note else self

    def to(self, form: Format) -> str:
        """Return the table as text in one of the formats.

        Raises
        ------
        InputError
            If a package that the format needs is missing.
        """
        match form:
            case "latex":
                return self.latex()
            case "markdown":
                return self.markdown()
            case "csv":
                return self.csv()
            case "html":
                return self.html()

    def latex(self) -> str:
        r"""Return the table as LaTeX, for documents with \usepackage{booktabs,siunitx}."""
        optional("jinja2", "experiments", "a LaTeX table")
        frame = self.frame.copy()
        frame.columns = _latex_header(columns_of(frame))
        frame.index.names = [name and _escaped(str(name)) for name in frame.index.names]
        style = frame.style.format(
            precision=0,
            formatter={
                new: self._form(old)
                for new, old in zip(frame.columns, columns_of(self.frame), strict=True)
            },
            na_rep="{-}",
        )
        style = style.format_index(escape="latex", axis=0)
        return str(
            style.to_latex(
                hrules=True,
                siunitx=True,
                multicol_align="c",
                multirow_align="naive",
                caption=_escaped(self.caption),
                position_float="centering",
                column_format="l" * frame.index.nlevels + self._specification(),
            )
        )

    def markdown(self) -> str:
        """Return the table as Markdown."""
        optional("tabulate", "experiments", "a Markdown table")
        shown = self._shown().reset_index()
        flat = shown.to_markdown(index=False, disable_numparse=True, colalign=self._alignment())
        return f"{flat}\n\n{self.caption}\n"

    def csv(self) -> str:
        """Return the table as CSV, in full precision."""
        flat = self.frame.copy()
        flat.columns = pd.Index(
            [" ".join(part for part in column if part) for column in columns_of(flat)]
        )
        return flat.to_csv(lineterminator="\n")

    def html(self) -> str:
        """Return the table as HTML."""
        optional("jinja2", "experiments", "an HTML table")
        frame = self.frame.copy()
        frame.columns = pd.MultiIndex.from_tuples(
            [(heading(measure), statistic) for measure, statistic in columns_of(frame)]
        )
        forms: dict[Any, str | Callable[[object], str] | None] = {
            new: _for_html(self._form(old))
            for new, old in zip(columns_of(frame), columns_of(self.frame), strict=True)
        }
        style = frame.style.format(forms, na_rep="-")
        style = style.format_index(escape="html", axis=0).format_index(escape="html", axis=1)
        # a name of its own instead of a random one: the same table is the same file
        return str(style.set_uuid("rmfs").set_caption(self.caption).to_html()) + "\n"

    def rich(self) -> object:
        """Return the table as an object of the package Rich, for printing in a terminal."""
        from rich import box
        from rich.table import Table as RichTable

        shown = self._shown().reset_index()
        made = RichTable(box=box.SIMPLE_HEAD, caption=self.caption, caption_justify="left")
        for number, column in enumerate(shown.columns):
            made.add_column(
                str(column),
                justify="left" if number < self.frame.index.nlevels else "right",
                overflow="fold",
            )
        for row in shown.itertuples(index=False):
            made.add_row(*(str(cell) for cell in row))
        return made

    def write(self, path: Path) -> None:
        """Write the table in the format given by the file's suffix.

        Raises
        ------
        InputError
            If the format is not supported.
        """
        form = SUFFIXES.get(path.suffix.lower())
        if form is None:
            raise InputError(f"{path}: unknown kind of table; valid: {', '.join(SUFFIXES)}")
        write_text(path, self.to(form))

    def _shown(self) -> pd.DataFrame:
        """Return the cells as text, with mean and half width combined."""
        made: dict[str, list[str]] = {}
        for measure, statistic in columns_of(self.frame):
            if statistic == HALF:
                continue
            form = self._form((measure, statistic))
            cells = [form(value) for value in self.frame[measure, statistic]]
            if (measure, HALF) in self.frame and statistic in ("mean", "difference"):
                halves = self.frame[measure, HALF]
                cells = [
                    cell if pd.isna(half) else f"{cell} ± {form(half)}"
                    for cell, half in zip(cells, halves, strict=True)
                ]
            name = heading(measure)
            made[name if statistic in ("mean", "") else f"{name}, {statistic}"] = cells
        return pd.DataFrame(made, index=self.frame.index)

    def _form(self, column: tuple[str, str]) -> Callable[[object], str]:
        """Return what writes the cells of a column."""
        return _p_value if "p" in column else _Fixed(self.decimals.get(column, 0))

    def _alignment(self) -> tuple[str, ...]:
        shown = self._shown()
        return ("left",) * self.frame.index.nlevels + ("right",) * shown.shape[1]

    def _specification(self) -> str:
        r"""Return the column types: numbers aligned at the point, words to the left."""
        parts = []
        for column in columns_of(self.frame):
            values = self.frame[column]
            if not pd.api.types.is_numeric_dtype(values):
                parts.append("l")
                continue
            if "p" in column:
                parts.append("S[table-format=<1.3]")
                continue
            decimals = self.decimals.get(column, 0)
            whole = max((len(f"{abs(v):.0f}") for v in values.dropna()), default=1)
            sign = "-" if (values < 0).any() else ""
            parts.append(f"S[table-format={sign}{whole}.{decimals}]")
        return "".join(parts)


def means(
    frame: pd.DataFrame,
    columns: Sequence[str] = COLUMNS,
    *,
    confidence: float = 0.95,
    method: Method = "t",
    by: str = "arm",
) -> Table:
    """Return means and half widths of their confidence intervals, one row per arm."""
    parts = {}
    counts: dict[str, pd.Series] = {}
    decimals: dict[tuple[str, str], int] = {}
    for column in columns:
        found = per_arm(frame, column, confidence=confidence, method=method, by=by)
        parts[column, "mean"], parts[column, HALF] = found["mean"], found["half_width"]
        shown = digits(found["half_width"], found["mean"])
        decimals |= {(column, "mean"): shown, (column, HALF): shown}
        counts[column] = found["count"]
    made = _with_counts(parts, counts, "seeds")
    caption = (
        f"Means over seeds with {100 * confidence:g}% confidence intervals ({_called(method)})."
    )
    return Table(made, decimals, caption)


def differences(
    frame: pd.DataFrame,
    columns: Sequence[str],
    baseline: str,
    *,
    confidence: float = 0.95,
    method: Method = "t",
    by: str = "arm",
) -> Table:
    """Return differences (arm minus baseline), with p values corrected by Holm's method.

    Differences are paired by seed, unless the arms were simulated without common random numbers.
    """
    from rmfs.experiments.statistics.intervals import independent
    from rmfs.experiments.statistics.paired import holm

    found = {
        column: against(frame, column, baseline, confidence=confidence, method=method, by=by)
        for column in columns
    }
    if empty := [column for column, table in found.items() if table.empty]:
        raise InputError(f"column {empty[0]}: no arm with values to compare with {baseline}")
    p_values = pd.concat([table["p"] for table in found.values()], keys=list(found))
    corrected = holm(p_values)
    parts = {}
    counts: dict[str, pd.Series] = {}
    decimals: dict[tuple[str, str], int] = {}
    for column, table in found.items():
        half = (table["high"] - table["low"]) / 2
        parts[column, "difference"], parts[column, HALF] = table["difference"], half
        parts[column, "p"] = corrected[column]
        shown = digits(half, table["difference"])
        decimals |= {(column, "difference"): shown, (column, HALF): shown, (column, "p"): 4}
        counts[column] = table["pairs"]
    made = _with_counts(parts, counts, "pairs")
    apart = independent(frame)
    paired, used = ("independent seeds", "Welch") if apart else ("paired by seed", _called(method))
    percent = f"{100 * confidence:g}%"
    caption = (
        f"Arm minus {baseline}, {paired}, with {percent} confidence intervals ({used}); "
        f"p values of {'Welch' if apart else 'paired t'} tests, corrected by Holm over the table."
    )
    return Table(made, decimals, caption)


def _with_counts(
    parts: Mapping[tuple[str, str], pd.Series], counts: Mapping[str, pd.Series], name: str
) -> pd.DataFrame:
    """Return the columns of a table with numbers of runs: one for all measures, if they agree."""
    first, *others = counts.values()
    columns = {(name, ""): first, **parts}
    if not all(first.equals(one) for one in others):
        own = {(measure, name): count for measure, count in counts.items()}
        order = list(counts)
        columns = dict(
            sorted((dict(parts) | own).items(), key=lambda part: order.index(part[0][0]))
        )
    made = pd.DataFrame(columns)
    made.columns = pd.MultiIndex.from_tuples(columns_of(made))
    return made


def effects(found: pd.DataFrame, column: str) -> Table:
    """Return an analysis of variance (`rmfs.experiments.statistics.anova`) as a table."""
    partial = ["partial_eta_sq", "partial_eta_sq_low", "partial_eta_sq_high"]
    chosen = ["sum_sq", "df", "f", "p", "eta_sq", *partial, "omega_sq"]
    made = found[chosen].copy()
    shown = [digits(made["sum_sq"] / 1000, made["sum_sq"]), 0, 2, 4, 3, 3, 3, 3, 3]
    made.columns = pd.MultiIndex.from_tuples([(name, "") for name in chosen])
    decimals = dict(zip(columns_of(made), shown, strict=True))
    told = found.attrs.get("interactions", "")
    how = f"type II sums of squares; {told}" if told else "type II sums of squares"
    percent = 100 * found.attrs["confidence"]
    caption = (
        f"Analysis of variance of {column} ({how}); low and high are the ends of the "
        f"{percent:g}% confidence interval of partial eta squared."
    )
    return Table(made, decimals, caption)


def rows_frame(rows: Mapping[str, Mapping[tuple[str, str], float]], name: str) -> pd.DataFrame:
    """Return rows as the data frame of a table.

    Parameters
    ----------
    rows
        For each row name, its cells by measure and statistic. The first row determines the columns.
    name
        Heading of the row names.
    """
    columns = pd.MultiIndex.from_tuples(list(next(iter(rows.values()))))
    cells = [[row.get(column, float("nan")) for column in columns] for row in rows.values()]
    return pd.DataFrame(cells, index=pd.Index(list(rows), name=name), columns=columns)


def columns_of(frame: pd.DataFrame) -> list[tuple[str, str]]:
    """Return the columns as pairs of measure and statistic."""
    return cast("list[tuple[str, str]]", list(frame.columns))


def _called(method: str) -> str:
    return {"t": "Student's t", "bootstrap": "BCa bootstrap"}.get(method, method)


def digits(halves: pd.Series, values: pd.Series) -> int:
    """Return the number of decimal places with which values and half widths are shown.

    The median half width then has two significant digits; without half widths, the largest value
    has four. At most six decimal places are used.
    """
    known = [h for h in halves.dropna() if h > ROUNDING and isfinite(h)]
    if not known:
        if ((values.dropna() - values.dropna().round()).abs() < ROUNDING).all():
            return 0
        # without half widths: four significant digits of the largest value
        known = [float(values.abs().max()) / 100]
    return int(min(6, max(0, 1 - floor(log10(sorted(known)[len(known) // 2])))))


def _for_html(form: Callable[[object], str]) -> Callable[[object], str]:
    return lambda value: escape(form(value))


def _p_value(value: object) -> str:
    return value if isinstance(value, str) else p_value(float(value))  # type: ignore[arg-type]


@dataclass(frozen=True)
class _Fixed:
    """Formats a cell: numbers with a fixed number of decimal places, strings unchanged."""

    decimals: int

    def __call__(self, value: object) -> str:
        if isinstance(value, str):
            return value
        number = round(float(value), self.decimals)  # type: ignore[arg-type]
        # avoids a negative zero: -0.0 + 0.0 is 0.0
        return "-" if number != number else f"{number + 0.0:.{self.decimals}f}"


def _latex_header(columns: list[tuple[str, str]]) -> pd.MultiIndex:
    signs = {HALF: r"{$\pm$}", "mean": "{mean}", "difference": "{difference}", "p": "{$p$}"}
    return pd.MultiIndex.from_tuples(
        [
            (_braced(heading(first)), signs.get(second, second and _braced(second)))
            for first, second in columns
        ]
    )


def _braced(text: str) -> str:
    return f"{{{_escaped(text)}}}"


def _escaped(text: str) -> str:
    signs = {sign: f"\\{sign}" for sign in "_%&#${}"}
    signs |= {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
    signs |= {"±": r"$\pm$", "<": r"$<$", ">": r"$>$", "²": "$^2$"}
    signs |= {"η": r"$\eta$", "ω": r"$\omega$"}
    return "".join(signs.get(sign, sign) for sign in text)
