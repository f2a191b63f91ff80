"""Torques, loads and losses of the gears of the book are those of rigid involutes."""

import pytest


def test_gears_turn_as_their_page_says(run_page, tmp_path):
    pytest.importorskip("matplotlib")
    space = run_page("gears.md")
    np, angle, alone, lag = space["np"], space["angle"], space["alone"], space["lag"]
    # A wheel that lags by more than a cell has lost its tooth.
    assert 2 <= alone.sum() <= len(alone) - 2 and 0 < lag.min() and lag.max() < 0.03
    # Where two pairs carry the wheel lags less.
    assert lag[alone].mean() > lag[~alone].mean() + 5e-4
    assert abs(space["torque"] * 30 / 20 / 20000 - 1).max() < 0.015
    assert abs(space["force"].sum(0) * space["R2"] / 20000 - 1).max() < 0.005
    assert abs(space["lost"][alone] - space["theory"]).max() < 7e-4
    # Friction changes its sign at the pitch point, and that of every pair is on one side before it and on the other behind it.
    past = angle[alone] - space["pitch_point"]
    carries = space["force"][:, alone].argmax(0)
    signs = np.sign(space["friction"][carries, np.flatnonzero(alone)])
    clear = abs(past) > 0.5 * (angle[1] - angle[0])
    assert (signs[clear] == np.sign(past[clear])).all() and (past > 0).any() and (past < 0).any()
    assert (tmp_path / "gears.png").is_file()
