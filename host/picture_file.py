"""Writes Matplotlib figures so that a file is never incomplete."""
import errno
import io
import os


def save(figure, path, colours=None, **how):
    """Writes a figure to a temporary file, then renames the file to `path`. `colours` limits the number of colours of
    a PNG, to keep the file small. Errors: OSError that names `path`; an old file at `path` then remains unchanged.
    """
    target = os.path.realpath(path)  # if `path` is a symbolic link, its target is replaced
    suffix = os.path.splitext(target)[1]
    target += "" if suffix else ".png"
    is_there = os.path.exists(target)
    if is_there and not (os.path.isfile(target) and os.access(target, os.W_OK)):
        raise OSError(errno.EACCES, "is not a file that may be written to", path)
    picture = io.BytesIO()
    figure.savefig(picture, format=suffix.lstrip(".") or "png", **how)
    if colours:
        from PIL import Image
        image = Image.open(picture).convert("RGB").quantize(colours, dither=Image.Dither.NONE)
        picture = io.BytesIO()
        image.save(picture, format="PNG", optimize=True)
    beside = os.path.join(os.path.dirname(target), f".dolp-{os.getpid()}.tmp")
    try:
        with open(beside, "wb") as file:
            file.write(picture.getbuffer())
            file.flush()
            os.fsync(file.fileno())
        if is_there:
            os.chmod(beside, os.stat(target).st_mode)
        os.replace(beside, target)
    except OSError as error:
        raise OSError(error.errno, error.strerror, path) from None
    finally:
        if os.path.exists(beside):
            os.unlink(beside)
