"""Kernels that a command needs later, compiled in other processes while it compiles those that it needs first."""

import os

from .. import kernel_cache
from ..kernel_cache import Use
from .command_end import until_command_ends


def compile_ahead(*uses: Use) -> None:
    """Begin to compile for uses to come, those first that take longest, until the command ends; where all is compiled, begin nothing.

    The command compiles what it needs as if nobody else did; a kernel that is being compiled elsewhere it waits for (`turns`).
    """
    missing = [use.function for use in uses if not kernel_cache.is_compiled(use.kernel)]
    if missing and os.access(kernel_cache.cache_folder(), os.W_OK):  # else none could hand its machine code over
        from ..jobs.ahead import ahead  # a second start does without

        until_command_ends.enter_context(ahead(missing))
