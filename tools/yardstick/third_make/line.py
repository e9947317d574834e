"""A transport delay that may change underway."""

from collections import deque

# No delay is longer.
LONGEST_S = 2.0


class Line:
    """Keeps what went in."""

    def __init__(self, dt_s: float):
        count = round(LONGEST_S / dt_s) + 1
        self._dt_s, self._line = dt_s, deque([0.0] * count, maxlen=count)

    def step(self, value: float, delay_s: float) -> float:
        """What went in a delay ago, nothing before the beginning."""
        self._line.append(value)
        return self._line[-1 - round(delay_s / self._dt_s)]
