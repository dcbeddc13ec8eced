"""A run, or a few, as one HTML page that needs nothing else: numbers, figures, and a player to scrub through."""

from gw_exudyn.report.page import MOST_RUNS, report_page, save_report

__all__ = ["MOST_RUNS", "report_page", "save_report"]
