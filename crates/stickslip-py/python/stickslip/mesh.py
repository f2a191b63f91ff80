"""Meshes from arrays, from meshio and from pyvista."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _core

#: Kind of cells: (name in meshio, number in VTK, nodes, dimension). Nodes are ordered as in both.
_KINDS = {
    "line2": ("line", 3, 2, 1),
    "line3": ("line3", 21, 3, 1),
    "tri3": ("triangle", 5, 3, 2),
    "tri6": ("triangle6", 22, 6, 2),
    "quad4": ("quad", 9, 4, 2),
    "quad8": ("quad8", 23, 8, 2),
    "tet4": ("tetra", 10, 4, 3),
    "tet10": ("tetra10", 24, 10, 3),
    "wedge6": ("wedge", 13, 6, 3),
    "wedge15": ("wedge15", 26, 15, 3),
    "hex8": ("hexahedron", 12, 8, 3),
    "hex20": ("hexahedron20", 25, 20, 3),
}
_FROM_MESHIO = {v[0]: k for k, v in _KINDS.items()}
_FROM_VTK = {v[1]: k for k, v in _KINDS.items()}

Facets = Union[ArrayLike, Sequence[ArrayLike]]


class Mesh:
    """Points, cells and named sets.

    Parameters
    ----------
    points
        Coordinates, shape ``(n, 2)`` or ``(n, 3)``.
    cells
        Node indices from 0 by kind of cell, shape ``(cells, nodes)``: ``tri3``, ``tri6``, ``quad4``, ``quad8``, ``tet4``, ``tet10``,
        ``wedge6``, ``wedge15``, ``hex8``, ``hex20``, with nodes in the order of VTK. Cells of lines (in the plane) or surfaces (in space) are not allowed here: see
        `facet_sets`.
    point_sets
        Point indices by name.
    cell_sets
        Cell indices by name; cells are counted over all kinds in the order of `cells`.
    facet_sets
        Facets on the boundary by name, each given by its nodes, corners first: shape ``(facets, nodes)``, or a list of such arrays where
        facets have different numbers of nodes. Their orientation does not matter.

    In a dictionary of `Problem.from_dict` it is the ``mesh`` of a body, ``{"block": {"mesh": mesh, "material": "steel"}}``; in the text of a problem it is named,
    ``body.block.mesh.name = "NAME"``, and given to `Problem.from_toml` as ``meshes={"NAME": mesh}``. It cannot be changed.

    Raises
    ------
    MeshError
        If a cell is inverted or collapsed, or indices do not fit.
    """

    def __init__(
        self,
        points: ArrayLike,
        cells: Mapping[str, ArrayLike],
        point_sets: Optional[Mapping[str, ArrayLike]] = None,
        cell_sets: Optional[Mapping[str, ArrayLike]] = None,
        facet_sets: Optional[Mapping[str, Facets]] = None,
    ) -> None:
        coordinates = np.asarray(points, dtype="<f8")
        if coordinates.ndim != 2 or coordinates.shape[1] not in (2, 3):
            raise ValueError(f"points have to be of shape (n, 2) or (n, 3), not {coordinates.shape}")
        blocks: list[tuple[str, np.ndarray]] = []
        for kind, nodes in cells.items():
            if kind not in _KINDS:
                known = ", ".join(k for k, v in _KINDS.items() if v[3] > 1)
                raise ValueError(f"there are no cells of kind `{kind}`; known are {known}")
            blocks.append((kind, _indices(nodes, _KINDS[kind][2], f"cells of kind {kind}")))
        dimensions = {_KINDS[kind][3] for kind, _ in blocks}
        if len(dimensions) != 1:
            raise ValueError("cells have to be of one dimension; give surfaces as facet_sets")
        dim = dimensions.pop()
        if coordinates.shape[1] == 2:
            coordinates = np.column_stack([coordinates, np.zeros(len(coordinates))])
        starts = np.cumsum([0] + [len(nodes) for _, nodes in blocks])
        by_cell: dict[str, list[tuple[int, int]]] = {}
        for name, chosen in (cell_sets or {}).items():
            flat = _flat(chosen, int(starts[-1]), f"cell set `{name}`")
            which = np.searchsorted(starts, flat, side="right") - 1
            by_cell[name] = list(zip(which.tolist(), (flat - starts[which]).tolist()))
        by_facet = {name: _facets(f, name) for name, f in (facet_sets or {}).items()}
        self._core = _core.Mesh(
            dim,
            np.ascontiguousarray(coordinates).tobytes(),
            [(kind, nodes.ravel().tolist()) for kind, nodes in blocks],
            {
                name: _flat(chosen, len(coordinates), f"point set `{name}`").tolist()
                for name, chosen in (point_sets or {}).items()
            },
            by_cell,
            by_facet,
        )

    def __deepcopy__(self, memo: Any) -> Mesh:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._core.state(),)

    @classmethod
    def from_meshio(cls, mesh: Any) -> Mesh:
        """From a mesh of `meshio`: the cells of the highest dimension, its point and cell sets, and physical groups of Gmsh.

        Sets of cells that are one dimension lower become facet sets.
        """
        blocks = [(_FROM_MESHIO.get(block.type), np.asarray(block.data)) for block in mesh.cells]
        known = [_KINDS[kind][3] for kind, _ in blocks if kind]
        unknown = {block.type for block, (kind, _) in zip(mesh.cells, blocks) if not kind and block.type != "vertex"}
        if unknown or not known:
            raise ValueError(f"the mesh has cells that stickslip does not know: {', '.join(sorted(unknown)) or 'none at all'}")
        groups: dict[str, list[np.ndarray]] = {}
        for name, chosen in mesh.cell_sets.items():
            if not name.startswith("gmsh:"):
                groups[name] = [np.asarray([] if c is None else c, dtype=np.int64) for c in chosen]
        tags = mesh.cell_data.get("gmsh:physical")
        for name, (tag, _) in mesh.field_data.items() if tags is not None else []:
            groups.setdefault(name, [np.flatnonzero(np.asarray(t) == tag) for t in tags])
        return cls._assembled(np.asarray(mesh.points), blocks, groups, dict(mesh.point_sets))

    @classmethod
    def from_pyvista(cls, grid: Any) -> Mesh:
        """From an unstructured grid of `pyvista`: its cells of the highest dimension.

        Point and cell arrays of booleans become sets; those of cells that are one dimension lower become facet sets.
        """
        grid = grid.cast_to_unstructured_grid()
        blocks, positions = [], []
        types = np.asarray(grid.celltypes)
        for number, nodes in grid.cells_dict.items():
            if int(number) not in _FROM_VTK:
                raise ValueError(f"the grid has cells of VTK type {number}, which stickslip does not know")
            blocks.append((_FROM_VTK[int(number)], np.asarray(nodes)))
            positions.append(np.flatnonzero(types == number))
        flags = {n: np.asarray(grid.cell_data[n]) for n in grid.cell_data.keys()}
        groups = {
            name: [np.flatnonzero(flag[at]) for at in positions] for name, flag in flags.items() if flag.dtype == bool
        }
        points = {n: np.asarray(grid.point_data[n]) for n in grid.point_data.keys()}
        point_sets = {name: np.flatnonzero(flag) for name, flag in points.items() if flag.dtype == bool}
        return cls._assembled(np.asarray(grid.points), blocks, groups, point_sets)

    @classmethod
    def _assembled(
        cls,
        points: np.ndarray,
        blocks: Sequence[tuple[Optional[str], np.ndarray]],
        groups: Mapping[str, Sequence[np.ndarray]],
        point_sets: Mapping[str, ArrayLike],
    ) -> Mesh:
        dim = max(_KINDS[kind][3] for kind, _ in blocks if kind)
        cells: dict[str, list[np.ndarray]] = {}
        for kind, nodes in blocks:
            if kind and _KINDS[kind][3] == dim:
                cells.setdefault(kind, []).append(nodes)
        # Blocks of one kind are put together: where does each of them start?
        first, start = {}, 0
        for kind, parts in cells.items():
            for part in parts:
                first[id(part)] = start
                start += len(part)
        cell_sets, facet_sets = {}, {}
        for name, chosen in groups.items():
            inside, facets = [], []
            for (kind, nodes), which in zip(blocks, chosen):
                if not kind or len(which) == 0:
                    continue
                if _KINDS[kind][3] == dim:
                    inside.append(first[id(nodes)] + which)
                elif _KINDS[kind][3] == dim - 1:
                    facets.append(nodes[which])
            if inside:
                cell_sets[name] = np.concatenate(inside)
            if facets:
                facet_sets[name] = facets
        if dim == 2 and points.shape[1] == 3:
            if np.ptp(points[:, 2]) > 0.0:
                raise ValueError("a mesh of triangles and quadrilaterals has to lie in the plane x, y")
            points = points[:, :2]
        merged = {kind: np.concatenate(parts) for kind, parts in cells.items()}
        points, merged, used = _without_unused(points, merged)
        point_sets = {name: _renumbered(np.asarray(s), used) for name, s in point_sets.items()}
        facet_sets = {name: [used[f] for f in facets] for name, facets in facet_sets.items()}
        return cls(points, merged, point_sets, cell_sets, facet_sets)

    @property
    def point_count(self) -> int:
        """Number of points."""
        return self._core.counts[0]

    @property
    def cell_count(self) -> int:
        """Number of cells."""
        return self._core.counts[1]

    @property
    def sets(self) -> dict[str, list[str]]:
        """Names of the sets: ``point``, ``cell`` and ``facet``."""
        return dict(zip(("point", "cell", "facet"), self._core.sets))

    def __repr__(self) -> str:
        sets = ", ".join(f"{kind} sets {names}" for kind, names in self.sets.items() if names)
        return f"<stickslip.Mesh: {self.point_count} points, {self.cell_count} cells{'; ' + sets if sets else ''}>"


def _restored(state: bytes) -> Mesh:
    mesh = Mesh.__new__(Mesh)
    mesh._core = _core.Mesh.restore(state)
    return mesh


def _indices(nodes: ArrayLike, columns: int, what: str) -> np.ndarray:
    array = np.asarray(nodes)
    if array.ndim != 2 or array.shape[1] != columns or not np.issubdtype(array.dtype, np.integer):
        raise ValueError(f"{what} have to be integers of shape (n, {columns}), not {array.dtype} of shape {array.shape}")
    if array.size and array.min() < 0:
        raise ValueError(f"{what}: indices start from 0")
    return array


def _flat(chosen: ArrayLike, count: int, what: str) -> np.ndarray:
    array = np.asarray(chosen)
    if array.dtype == bool:
        array = np.flatnonzero(array)
    array = array.ravel().astype(np.int64)
    if array.size and (array.min() < 0 or array.max() >= count):
        raise IndexError(f"{what} has an index outside of 0 to {count - 1}")
    return array


def _facets(facets: Any, name: str) -> list[tuple[int, list[int]]]:
    parts = facets if isinstance(facets, (list, tuple)) and facets and np.ndim(facets[0]) == 2 else [facets]
    arrays = [np.asarray(part) for part in parts]
    for array in arrays:
        if array.ndim != 2 or array.shape[1] < 2:
            raise ValueError(f"facet set `{name}` has to be of shape (facets, nodes), not {array.shape}")
    return [(array.shape[1], array.ravel().tolist()) for array in arrays]


def _without_unused(
    points: np.ndarray, cells: Mapping[str, np.ndarray]
) -> tuple[np.ndarray, dict[str, np.ndarray], np.ndarray]:
    """Points that only lines, surfaces or nothing use would have no stiffness."""
    used = np.zeros(len(points), dtype=bool)
    for nodes in cells.values():
        used[nodes.ravel()] = True
    number = np.cumsum(used) - 1
    number[~used] = -1
    return points[used], {kind: number[nodes] for kind, nodes in cells.items()}, number


def _renumbered(chosen: np.ndarray, number: np.ndarray) -> np.ndarray:
    if chosen.dtype == bool:
        chosen = np.flatnonzero(chosen)
    new = number[chosen.astype(np.int64)]
    return new[new >= 0]
