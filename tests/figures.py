"""What tests of figures ask again and again."""

import matplotlib as mpl

from compendium import reference
from facegear.support import labelled


def texts(drawing):
    """Return all text of a drawing, joined by blanks."""
    drawing.canvas.draw()
    return " ".join(text.get_text() for text in drawing.findobj(mpl.text.Text))


def check_round_trip(dataset, tmp_path):
    """Hold that nothing changes on the way through a file."""
    stored = labelled.load(labelled.save(dataset, tmp_path / "figure.nc"))
    assert all(row.largest_absolute == 0.0 for row in reference.compare(dataset, stored))
