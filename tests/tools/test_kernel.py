"""`make test-kernel` runs under another kernel, or says why it does not."""

import json
import os
import platform
import re
import subprocess
import sys

import numpy as np
import pytest

from tools import test_kernel as tool

KERNEL = tool.KERNELS.get(platform.machine())
COMPUTE = """
import json
import numpy as np
from tools.test_kernel import in_use
factor = np.random.default_rng(1).normal(size=(70, 70))
print(json.dumps([in_use(), (factor @ factor).tolist()]))
"""


def computed(environment):
    """Return what a process uses, and a product it computes; warnings are errors, as in the tests."""
    command = [sys.executable, "-W", "error", "-c", COMPUTE]
    done = subprocess.run(command, cwd=tool.ROOT, env=environment, stdout=subprocess.PIPE, check=True)
    return json.loads(done.stdout)


@pytest.mark.slow
@pytest.mark.skipif(KERNEL is None, reason="no other kernel is known for this processor")
def test_the_other_kernel_has_other_last_digits():
    plain = {name: value for name, value in os.environ.items() if name not in tool.switched("", ())}
    here, product = computed(plain)
    there, other = computed(plain | tool.switched(KERNEL, here["numpy"]))
    if here == there:
        pytest.skip("this processor is the other one")
    assert tool.problem(KERNEL, here, there) is None
    np.testing.assert_allclose(other, product, rtol=0.0, atol=1e-12)
    assert other != product


@pytest.mark.parametrize(
    ("there", "message"),
    [
        ({"blas": ["Haswell"], "numpy": []}, "asked for the kernel Nehalem alone"),
        ({"blas": ["Haswell", "Nehalem"], "numpy": []}, "asked for the kernel Nehalem alone"),
        ({"blas": ["Nehalem"], "numpy": ["X86_V3"]}, "got .* and .'X86_V3'."),
        ({"blas": [], "numpy": []}, "asked for the kernel Nehalem alone"),
    ],
)
def test_a_switch_without_effect_is_told(there, message):
    here = {"blas": ["Haswell"], "numpy": ["X86_V3"]}
    assert re.search(message, tool.problem("Nehalem", here, there))
    old = {"blas": ["Nehalem"], "numpy": []}
    assert "nothing new" in tool.problem("Nehalem", old, old)
    assert tool.problem("Nehalem", here, old) is None


def test_an_unknown_processor_is_told(monkeypatch, capsys):
    monkeypatch.setattr(platform, "machine", lambda: "abacus")
    assert tool.main([]) == 1
    assert "abacus" in capsys.readouterr().err
