"""What pages and chapters may not say: results without a number, and numbers that are not those of the arrays."""

import json
import re
from pathlib import Path

import pytest

from compendium.datasets.map_readings import unstable_share
from facegear.support.labelled import load

ROOT = Path(__file__).resolve().parents[2]
PAGES = [*(ROOT / "book").glob("*.md"), ROOT / "README.md"]
# A sentence with one of these claims more than a computation has shown.
TOO_MUCH = re.compile(
    r"safe side|on the safe|whatever the phase|not matter|hardly matter|hangs on|(?<!un)safe zone", re.I
)
# The dissertation's own term, where the text quotes it.
QUOTED = ("marks a safe zone",)


def texts() -> dict[str, str]:
    found = {page.name: page.read_text(encoding="utf-8") for page in PAGES}
    for path in (ROOT / "notebooks").glob("*.ipynb"):
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        found[path.name] = "\n".join("".join(cell["source"]) for cell in cells) + json.dumps(
            [cell["metadata"] for cell in cells], ensure_ascii=False
        )
    return found


@pytest.mark.parametrize("name", sorted(texts()))
def test_no_sentence_claims_more_than_was_computed(name: str) -> None:
    text = texts()[name]
    for quotation in QUOTED:
        text = text.replace(quotation, "")
    assert [match.group() for match in TOO_MUCH.finditer(text)] == []


def test_readme_has_the_shares_of_the_stored_maps() -> None:
    shares = [
        100 * unstable_share(load(ROOT / "data" / "reference" / f"ch04_{name}_4_04a.nc"))
        for name in ("figure", "geometric")
    ]
    said = re.search(
        r"\bit (\S+) % of the map of Fig. 4.4\(a\) is unstable,[^%]*?(\S+) %",
        (ROOT / "README.md").read_text(),
    )
    assert said is not None
    assert said.groups() == (f"{shares[0]:.0f}", f"{shares[1]:.1f}")


@pytest.mark.parametrize("page", ["README.md", "book/intro.md"])
def test_the_exception_to_the_headline_has_the_shares_of_the_stored_maps(page: str) -> None:
    def share(figure: str, model: str) -> float:
        stored = load(ROOT / "data" / "reference" / f"{figure}.nc")
        growth = stored.growth_rate[stored.model_name.values.tolist().index(model)]
        return 100.0 * float((growth > 0.0).mean())

    of_map = share("ch08_sharing", "pair; clock of the load")
    of_row = [share("ch08_bases", f"load, rigid pairs, M, N = {basis}") for basis in ("1, 3", "2, 8")]
    text = " ".join((ROOT / page).read_text(encoding="utf-8").split())
    said = re.search(
        r"leaves (\S+) % of the map of Case I unstable at the rated torque; of the speeds at μ = 1 it is (\S+) % in "
        r"the dissertation's basis and (\S+) % in the largest one tried",
        text,
    )
    assert said is not None
    assert said.groups() == (f"{of_map:.0f}", f"{of_row[0]:.0f}", f"{of_row[1]:.1f}")
