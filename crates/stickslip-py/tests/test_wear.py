"""The wear coefficient that the page of the book fits to made-up scars is the one they were made with."""


def test_the_coefficient_comes_back_from_scars_with_noise(run_page):
    space = run_page("wear-coefficient.md")
    k, true, deviation = space["k"], space["true"], space["deviation"]
    assert k != space["guess"]
    assert abs(k - true) < 4 * deviation + 0.005 * true
    assert deviation < 0.01 * true
    # Without noise what is left is what jumps of 50 cycles and straight lines between them do.
    clean = [h for n in (500, 1000, 2000) for h in space["np"].interp(space["x_read"], space["places"], space["measured"][abs(space["n_measured"] - n).argmin()])]
    assert abs(space["model"](true) - clean).max() < 0.03 * max(clean)
