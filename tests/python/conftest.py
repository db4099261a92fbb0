import os
import pathlib

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
INSONIFY = pathlib.Path(os.environ.get("INSONIFY_BUILD", ROOT / "build")) / "bin/insonify"


@pytest.fixture
def deploy():
    """The folder with the deployments."""
    return ROOT / "deploy"


def pytest_configure(config):
    config.addinivalue_line("markers", "slow: tests of many seconds, which scripts/test --quick omits")
