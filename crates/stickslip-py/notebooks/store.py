"""Runs the notebooks and stores them with what they show: ``python store.py`` (needs nbclient, ipykernel, matplotlib)."""

from pathlib import Path

import nbclient
import nbformat

for path in sorted(Path(__file__).parent.glob("*.ipynb")):
    notebook = nbformat.read(path, as_version=4)
    # Figures of a page, not of a poster: they are kept in the repository.
    setup = nbformat.v4.new_code_cell("%matplotlib inline\nimport matplotlib\nmatplotlib.rcParams['figure.dpi'] = 60")
    notebook.cells.insert(0, setup)
    nbclient.NotebookClient(notebook, timeout=300).execute()
    del notebook.cells[0]
    notebook.metadata = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    for count, cell in enumerate((c for c in notebook.cells if c.cell_type == "code"), start=1):
        cell.execution_count = count
        for output in cell.outputs:
            if "execution_count" in output:
                output.execution_count = count
    for number, cell in enumerate(notebook.cells):
        cell.id = f"cell-{number}"
        cell.metadata = {}
    notebook.nbformat_minor = 5
    nbformat.write(notebook, path)
    print(path, path.stat().st_size)
