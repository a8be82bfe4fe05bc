"""A process that uses a kernel, or five, for tests/test_kernel_cache.py: prints their answers, then how often each was on disk."""

import os
import sys

from clamber.compiled import kernel

if "open" in sys.argv:
    os.umask(0)


@kernel
def doubled(x):
    return x + x


kernels = [doubled]
if "more" in sys.argv:

    @kernel
    def cut(x):
        return x - 1.0

    @kernel
    def garbage(x):
        return x - 2.0

    @kernel
    def empty(x):
        return x - 3.0

    @kernel
    def flipped(x):
        return x - 4.0

    kernels += [cut, garbage, empty, flipped]
print(*(each(4.0) for each in kernels), *(sum(each.stats.cache_hits.values()) for each in kernels))
