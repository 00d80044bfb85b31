"""What agents of Tartarus ask Python for: see prolog/tartarus/devices.pl."""

import contextlib
import importlib.util
import io
import os
import shutil
import subprocess


def python_result(folder, file, function, arguments):
    """The last line of what a function of folder/file.py gives, as text.

    The file is read for each call, and what it prints is not shown.
    """
    path = os.path.join(folder, file + '.py')
    spec = importlib.util.spec_from_file_location(file, path)
    module = importlib.util.module_from_spec(spec)
    with contextlib.redirect_stdout(io.StringIO()):
        spec.loader.exec_module(module)
        result = getattr(module, function)(*arguments)
    return ([''] + str(result).split('\n'))[-1]


def python_say(words):
    """Speak, where there is a program for it."""
    for name in ('espeak-ng', 'espeak'):
        program = shutil.which(name)
        if program:
            return subprocess.run([program, '--', words], check=False,
                                  stdin=subprocess.DEVNULL).returncode == 0
    return False
