"""The command line that repeats a command, as one would type it."""

import shlex
from collections.abc import Container

import typer


def repeat_words(context: typer.Context, without: Container[str]) -> str:
    """The command with its arguments and the options that are not as usual.

    Args:
        context: Of the command that runs.
        without: Names of parameters that change nothing of what comes out, such as files to write.
    """
    words = context.command_path.split()
    options: list[str] = []
    for parameter in context.command.params:
        name = parameter.name or ""
        value = context.params.get(name)
        if name in without or value is None or value == parameter.get_default(context):
            continue
        if parameter.param_type_name == "argument":
            words.append(str(value))
        elif isinstance(value, bool):
            options.append(parameter.opts[0] if value else parameter.secondary_opts[0])
        else:
            for one in value if isinstance(value, list | tuple) else (value,):
                options += [parameter.opts[0], str(one)]
    return shlex.join([*words, *options])
