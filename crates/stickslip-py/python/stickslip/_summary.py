"""What `summary.json` holds, with its types. `tests/test_types.py` compares it with what a run writes."""

from __future__ import annotations

from typing import Any, Optional, TypedDict

Place = TypedDict("Place", {"what": str, "name": Optional[str], "id": Optional[int], "body": Optional[str], "interface": Optional[str], "position": Optional[list[float]], "remark": str})

Finding = TypedDict(
    "Finding",
    {
        "cause": str,
        "severity": str,
        "message": str,
        "suspects": list[Place],
        "tried": list[str],
        "advice": list[str],
        "step": Optional[int],
        "time": Optional[float],
    },
)

Size = TypedDict("Size", {"points": int, "cells": int, "dofs": int, "contact-points": int})

Energy = TypedDict(
    "Energy",
    {
        "kinetic": float,
        "strain": float,
        "contact": float,
        "friction": float,
        "contact-damping": float,
        "rayleigh-damping": float,
        "numerical": float,
        "artificial": float,
        "external-work": float,
        "belt-work": float,
        "path": float,
        "uncertain": float,
        "initial": float,
        "residual": float,
    },
)

EnergyQuality = TypedDict("EnergyQuality", {"scale": float, "largest": float, "residual": float, "limit": float, "met": bool})

Quality = TypedDict("Quality", {"gate": str, "met": bool, "figures": list[dict[str, Any]]})

Peak = TypedDict("Peak", {"value": float, "at": list[float], "time": float})

Points = TypedDict("Points", {"stick": int, "slip": int, "open": int})

Interface = TypedDict(
    "Interface",
    {
        "name": str,
        "exchanged": bool,
        "tied": bool,
        "peak-pressure": Peak,
        "peak-traction": Peak,
        "pressure": float,
        "normal-force": list[float],
        "shear-force": list[float],
        "area": float,
        "points": Points,
        "friction-work": float,
        "quality": dict[str, float],
        "relative-to-approach": float,
        "action-reaction": float,
        "moment": float,
        "numerical-stiffness": Optional[dict[str, Any]],
    },
    total=False,
)

Summary = TypedDict(
    "Summary",
    {
        "title": str,
        "version": str,
        "status": str,
        "outcome": str,
        "completed": bool,
        "findings": list[Finding],
        "method": str,
        "method-reason": str,
        "engine": dict[str, Any],
        "notes": list[str],
        "size": Size,
        "increments": int,
        "iterations": int,
        "events": int,
        "cutbacks": int,
        "cycles-taken-back": int,
        "cutback-reasons": list[str],
        "fallbacks": list[dict[str, Any]],
        "friction-solvers": dict[str, int],
        "stable-increment": float,
        "mass-added": float,
        "largest-rotation": float,
        "followed": int,
        "artificial-energy": float,
        "solver": dict[str, float],
        "phases": dict[str, float],
        "linear-solve": float,
        "relative-to-linear": float,
        "peak-memory": int,
        "page-faults": int,
        "threads": int,
        "energy": Energy,
        "energy-quality": EnergyQuality,
        "quality": Quality,
        "interfaces": list[Interface],
        "modes": list[dict[str, Any]],
        "growth": list[dict[str, Any]],
        "fatigue": list[dict[str, Any]],
        "last": dict[str, float],
    },
    total=False,
)
Summary.__doc__ = "What ``summary.json`` holds, by key."
