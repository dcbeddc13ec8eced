"""Figures of results: the wire in the vessel with its contact forces, forces, the tip's path, energies, contacts
along the wire.

Each `plot_*` returns a matplotlib Figure and touches neither a display nor matplotlib's global state; `save_figures`
writes all of a run.
"""

from gw_exudyn.plots.animation import save_animation
from gw_exudyn.plots.comparison import plot_comparison
from gw_exudyn.plots.contact_map import plot_contact_map
from gw_exudyn.plots.energy import plot_energy
from gw_exudyn.plots.forces import plot_forces
from gw_exudyn.plots.insertion import plot_insertion
from gw_exudyn.plots.save import FIGURES, save_figure, save_figures
from gw_exudyn.plots.tip_path import plot_tip_path

__all__ = [
    "FIGURES",
    "plot_comparison",
    "plot_contact_map",
    "plot_energy",
    "plot_forces",
    "plot_insertion",
    "plot_tip_path",
    "save_animation",
    "save_figure",
    "save_figures",
]
