import pathlib

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture
def deploy():
    """The folder with the deployments."""
    return ROOT / "deploy"
