"""Meshes from arrays."""

import numpy as np
import pytest

import stickslip


def last_shear(case, **given):
    simulation = stickslip.Problem.from_dict(case, **given).build().run()
    return simulation.history["press.CFS1"][-1]


@pytest.fixture
def block(rectangle):
    points, cells = rectangle(np.linspace(1, 2, 6), np.linspace(0, 1, 6))
    below = np.flatnonzero(points[:, 1] == 0)
    return {
        "points": points,
        "cells": {"quad4": cells},
        "point_sets": {"top": points[:, 1] == 1},
        "facet_sets": {"bottom": np.column_stack([below[:-1], below[1:]])},
    }


def test_a_mesh_of_arrays_gives_what_the_generator_gives(case, block):
    wanted = last_shear(case)
    del case["body"]["block"]["generate"]
    mesh = stickslip.Mesh(**block)
    assert (mesh.point_count, mesh.cell_count) == (36, 25)
    assert mesh.sets == {"point": ["top"], "cell": [], "facet": ["bottom"]}
    case["body"]["block"]["mesh"] = mesh
    assert last_shear(case) == pytest.approx(wanted, rel=1e-9)
    case["body"]["block"]["mesh"] = {"name": "mine"}
    assert last_shear(case, meshes={"mine": mesh}) == pytest.approx(wanted, rel=1e-9)
    # As a file that is not there.
    del case["body"]["block"]["mesh"]
    case["body"]["block"]["gmsh"] = {"file": "mine"}
    assert last_shear(case, meshes={"mine": mesh}) == pytest.approx(wanted, rel=1e-9)


def test_meshes_are_named_by_their_bodies_and_may_be_exchanged(case, block):
    wanted = last_shear(case)
    del case["body"]["block"]["generate"]
    mesh = stickslip.Mesh(**block)
    case["body"]["block"]["mesh"] = mesh
    problem = stickslip.Problem.from_dict(case)
    assert problem["body.block.mesh"] == {"name": "block"} and 'mesh.name = "block"' in problem.to_toml().replace("[body.block.mesh]\nname", "mesh.name")
    shrunk = stickslip.Mesh(block["points"] * [1.0, 0.5], block["cells"], block["point_sets"], facet_sets=block["facet_sets"])
    problem["body.block.mesh"] = shrunk
    other = problem.build().run().history["press.CFS1"][-1]
    assert other != pytest.approx(wanted, rel=1e-3)
    problem["body.block.mesh"] = mesh
    assert problem.build().run().history["press.CFS1"][-1] == pytest.approx(wanted, rel=1e-9)


def test_a_mesh_that_was_not_given_is_named(case, block):
    del case["body"]["block"]["generate"]
    case["body"]["block"]["mesh"] = {"name": "mine"}
    with pytest.raises(stickslip.ProblemError, match="no mesh `mine` was given") as caught:
        stickslip.Problem.from_dict(case).build()
    assert caught.value.findings[0]["key"] == "body.block.mesh.name" and "meshes=" in str(caught.value)
    mesh = stickslip.Mesh(**block)
    with pytest.raises(stickslip.ProblemError, match="these were given: yours"):
        stickslip.Problem.from_dict(case, meshes={"yours": mesh}).build()
    case["body"]["block"]["mesh"] = {"name": mesh, "group": "none"}
    with pytest.raises(stickslip.ProblemError, match="has no cell set `none`"):
        stickslip.Problem.from_dict(case).build()


def test_meshio_meshes_keep_their_sets(case, block):
    meshio = pytest.importorskip("meshio")
    wanted = last_shear(case)
    points = np.column_stack([block["points"], np.zeros(36)])
    # An unused point, as Gmsh leaves them, in front.
    points = np.vstack([[9.0, 9.0, 0.0], points])
    cells = [("line", block["facet_sets"]["bottom"] + 1), ("quad", block["cells"]["quad4"] + 1)]
    top = np.flatnonzero(points[:, 1] == 1)
    sets = {"bottom": [np.arange(5), np.array([], int)], "all": [None, np.arange(25)]}
    mesh = stickslip.Mesh.from_meshio(meshio.Mesh(points, cells, point_sets={"top": top}, cell_sets=sets))
    assert (mesh.point_count, mesh.cell_count) == (36, 25)
    assert mesh.sets == {"point": ["top"], "cell": ["all"], "facet": ["bottom"]}
    del case["body"]["block"]["generate"]
    case["body"]["block"]["mesh"] = {"name": mesh, "group": "all"}
    assert last_shear(case) == pytest.approx(wanted, rel=1e-9)


def test_pyvista_grids_in_space():
    pyvista = pytest.importorskip("pyvista")
    x = np.linspace(0, 1, 4)
    box = pyvista.RectilinearGrid(x, x, x).cast_to_unstructured_grid()
    # VTK knows voxels, whose nodes are ordered otherwise.
    voxels = box.cells.reshape(-1, 9)[:, 1:]
    hexes = voxels[:, [0, 1, 3, 2, 4, 5, 7, 6]]
    grid = pyvista.UnstructuredGrid({pyvista.CellType.HEXAHEDRON: hexes}, box.points)
    grid.point_data["base"] = grid.points[:, 2] == 0
    grid.cell_data["half"] = np.arange(27) < 13
    mesh = stickslip.Mesh.from_pyvista(grid)
    assert (mesh.point_count, mesh.cell_count) == (64, 27)
    assert mesh.sets == {"point": ["base"], "cell": ["half"], "facet": []}


def test_what_is_wrong_with_a_mesh_is_said(block):
    with pytest.raises(ValueError, match="there are no cells of kind `quad5`"):
        stickslip.Mesh(block["points"], {"quad5": block["cells"]["quad4"]})
    with pytest.raises(ValueError, match=r"shape \(n, 4\)"):
        stickslip.Mesh(block["points"], {"quad4": np.zeros((3, 3), int)})
    with pytest.raises(IndexError, match="no point 99"):
        stickslip.Mesh(block["points"], {"quad4": [[0, 1, 99, 2]]})
    with pytest.raises(ValueError, match="facet set `inside`"):
        stickslip.Mesh(block["points"], block["cells"], facet_sets={"inside": [[7, 8]]})
    with pytest.raises(stickslip.MeshError):
        stickslip.Mesh(block["points"], {"quad4": block["cells"]["quad4"][:, ::-1]})
