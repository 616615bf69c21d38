"""What cells of a notebook show: IPython with matplotlib's inline backend, in a process of its own."""

import json
import subprocess
import sys

import pytest

NOTEBOOK = """
import json, sys
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output

class Shell(InteractiveShell):
    def enable_gui(self, gui=None):
        pass  # there are no windows

def shown(cell):
    values.clear()
    with capture_output() as found:
        result = shell.run_cell(cell)
    result.raise_error()
    return sum("image/png" in one for one in [*values, *(output.data for output in found.outputs)])

shell, values = Shell.instance(), []
shell.displayhook.write_format_data = lambda data, *more: values.append(data)  # of the value of a cell
shell.run_line_magic("matplotlib", "inline")
print(json.dumps([shown(cell) for cell in json.load(sys.stdin)]))
"""
BEGIN = """
import matplotlib.pyplot as plt
import numpy as np
import vibro_sweep as vs
system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=6.6)
data = vs.sweep(system, {"b": np.linspace(6, 7, 5)}, observe=["section"], transient=5, record=5)
"""
IMAGES = {  # cell -> how often it shows a figure
    "vs.plot(data)": 1,
    "fig = vs.plot(data)": 0,  # as any value that has a name
    "fig": 1,
    "fig, ax = plt.subplots()\nvs.plot(data, ax=ax)": 1,
    "fig, ax = plt.subplots()\nreturned = vs.plot(data, ax=ax)": 1,
    "vs.plot(data, ax=plt.figure().subplots());": 1,
    "from matplotlib.figure import Figure\nvs.plot(data, ax=Figure().subplots())": 0,
}


@pytest.mark.slow
def test_each_figure_is_shown_once():
    pytest.importorskip("IPython")
    pytest.importorskip("matplotlib_inline")
    cells = json.dumps([BEGIN, *IMAGES])
    done = subprocess.run([sys.executable, "-c", NOTEBOOK], input=cells, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert dict(zip(["", *IMAGES], json.loads(done.stdout), strict=True)) == {"": 0} | IMAGES
