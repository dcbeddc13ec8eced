"""Pages that need nothing else: of a run or a few, with a player to scrub through; of a study; of sections."""

from gw_exudyn.report.document import Section, Sheet, document_page
from gw_exudyn.report.page import MOST_RUNS, report_page, save_report
from gw_exudyn.report.parts import save_page

__all__ = ["MOST_RUNS", "Section", "Sheet", "document_page", "report_page", "save_page", "save_report"]
