r"""Which readings of sensors to believe, and which joints do not answer their motors. Kernel.

A reading a is believed where :math:`|a - (x + v k T)| \le v_{max} k T`, with x and v of the last reading that was believed, k ticks of T
ago: no joint gets farther from going on as it went than its fastest speed brings it. Others are bridged by :math:`x + v k T`.
"""

import math

from ..compiled import kernel, opened

FASTEST, ANSWER, FULL, SLOW, AGAINST = 0, 1, 2, 3, 4
"""Rows of `bounds`: largest speed; change of the command that moves every joint; a command that is nearly all that there is, and the
speed below which a joint does not follow it; speed against it beyond which the joint gives way."""
VALUE, SPEED, AGE, SEEN, SAME, LOW, HIGH, DRIVEN, MEAN, YIELDING, LOOSE, LOOSE_LOW, LOOSE_HIGH = range(13)
"""Rows of `memory`: last believed value and speed, ticks since; whether there is one; ticks without any change of the reading, least and
largest command meanwhile; ticks of a full command that the joint does not follow; the command, smoothed; ticks of a full command against
which the joint gives way; of a joint that is free, ticks without any change since then, least and largest command meanwhile."""
BOUNDS, MEMORY = 5, 13
"""Rows of each."""
BELIEVED, NO_NUMBER, JUMP, NOTHING_NEW = 0, 1, 2, 3
"""Verdicts."""


@kernel
def check_readings(handle, elapsed):
    """Believe or bridge the readings of a tick.

    Args:
        handle: Holds, in this order,
            values, speeds: As read, and as believed afterwards, shape (n,);
            commands: Of the motors since the reading before, shape (n,);
            free: Whether nothing but its motor and what it carries moved a joint under them, shape (n,);
            bounds: Rows as above, shape (5, n);
            patience: Ticks for which a joint may stay where it is, may not follow a full command, and may turn against one, shape (3,);
            memory: Rows as above; changed, shape (13, n);
            verdicts: Filled, shape (n,);
            period: Between two ticks [s];
            smoothing: Part of the way to the newest command that the smoothed one goes in a tick.
        elapsed: Ticks since the newest reading before; 0: there is no newer one.

    Returns:
        Whether there is anything to look at: a reading not believed, or a joint that does not answer its motor.
    """
    values, speeds, commands, free, bounds, patience, memory, verdicts, period, smoothing = opened(handle)
    told = False
    for c in range(values.size):
        a = values[c]
        v = speeds[c]
        x = memory[VALUE, c]
        age = memory[AGE, c] + max(elapsed, 1)
        ahead = age * period
        command = commands[c]
        memory[MEAN, c] += smoothing * (command - memory[MEAN, c])
        verdict = BELIEVED
        if elapsed == 0:
            verdict = NOTHING_NEW
        elif not math.isfinite(a):
            verdict = NO_NUMBER
        elif memory[SEEN, c] > 0.0 and abs(a - (x + memory[SPEED, c] * ahead)) > bounds[FASTEST, c] * ahead:
            verdict = JUMP
        verdicts[c] = verdict
        if verdict != BELIEVED:
            memory[AGE, c] = age
            values[c] = x + memory[SPEED, c] * ahead
            speeds[c] = memory[SPEED, c]
            told = True
            continue
        if memory[SEEN, c] > 0.0 and (age > 1.0 or not math.isfinite(v)):
            v = (a - x) / ahead  # the speed as read may be that from a reading that was not believed
            speeds[c] = v
        unchanged = memory[SEEN, c] > 0.0 and a == x
        if unchanged:
            memory[SAME, c] += age
            memory[LOW, c] = min(memory[LOW, c], command)
            memory[HIGH, c] = max(memory[HIGH, c], command)
        else:
            memory[SAME, c] = 0.0
            memory[LOW, c] = command
            memory[HIGH, c] = command
        if unchanged and free[c] and memory[LOOSE, c] > 0.0:
            memory[LOOSE, c] += age
            memory[LOOSE_LOW, c] = min(memory[LOOSE_LOW, c], command)
            memory[LOOSE_HIGH, c] = max(memory[LOOSE_HIGH, c], command)
        else:
            memory[LOOSE, c] = age if free[c] else 0.0
            memory[LOOSE_LOW, c] = command
            memory[LOOSE_HIGH, c] = command
        along = v if command > 0.0 else -v
        full = abs(command) >= bounds[FULL, c]
        memory[DRIVEN, c] = memory[DRIVEN, c] + age if full and along < bounds[SLOW, c] else 0.0
        memory[YIELDING, c] = memory[YIELDING, c] + age if full and along < -bounds[AGAINST, c] else 0.0
        if memory[SAME, c] >= patience[0] and memory[HIGH, c] - memory[LOW, c] > bounds[ANSWER, c]:
            told = True
        if memory[DRIVEN, c] >= patience[1] or memory[YIELDING, c] >= patience[2]:
            told = True
        memory[VALUE, c] = a
        memory[SPEED, c] = min(max(v, -bounds[FASTEST, c]), bounds[FASTEST, c])
        memory[AGE, c] = 0.0
        memory[SEEN, c] = 1.0
    return told
