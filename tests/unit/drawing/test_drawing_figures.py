"""The marks of the drawing: all of them are measured, and each is a figure that can be."""

from __future__ import annotations

from silverball.benchmarks import drawing


def test_every_mark_of_the_drawing_is_measured(monkeypatch):
    monkeypatch.setattr(drawing, "HEIGHT", 96)
    monkeypatch.setattr(drawing, "FRAMES", 4)
    said = []
    figures = drawing.measure_drawing(1, said.append)
    assert len(figures) == 11
    assert len({figure.name for figure in figures}) == 11
    assert all(figure.value > 0.0 for figure in figures)
    assert {figure.unit for figure in figures} == {"s", "ms", "frames/s"}
    assert len(said) > 4
