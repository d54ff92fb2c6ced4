"""How hypothesis behaves in every test: reproducibly where a machine checks, freely where a person does.

HYPOTHESIS_PROFILE=thorough looks at twenty times as many examples.
"""

import os

from hypothesis import HealthCheck, settings

anywhere = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("default", anywhere)
settings.register_profile("ci", anywhere, derandomize=True)
settings.register_profile("thorough", anywhere, max_examples=2000)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "ci" if "CI" in os.environ else "default"))
