"""The file of results of posevote batch."""

import json
import os
from collections import deque
from pathlib import Path

import posevote


class Results:
    """Lines in a fixed order, beside a file that says what they belong to."""

    def __init__(self, path, belongs_to, restart):
        self.path = Path(path)
        self.note = self.path.with_name(self.path.name + ".batch")
        if restart:
            self.path.unlink(missing_ok=True)
            self.note.unlink(missing_ok=True)
        self.check(belongs_to)
        self.written = self.cut_off()
        self.file = open(self.path, "ab")

    def check(self, belongs_to):
        text = json.dumps(belongs_to, sort_keys=True, ensure_ascii=False)
        if self.note.exists():
            if self.note.read_text(encoding="utf-8") != text:
                raise posevote.AlreadyExistsError(
                    f"'{self.path}' was begun with other objects or options; "
                    "name another file, or begin it again with --restart"
                )
        elif self.path.exists() and self.path.stat().st_size:
            raise posevote.AlreadyExistsError(
                f"'{self.path}' exists and was not made by posevote batch; name another file"
            )
        else:
            made = self.note.with_name(self.note.name + ".part")
            made.write_text(text, encoding="utf-8")
            os.replace(made, self.note)

    def cut_off(self):
        """Removes what was not finished, or is damaged since a power cut, and all after it; returns
        (image, frame, is error) of each other line."""
        written, end = deque(), 0
        if not self.path.exists():
            return written
        with open(self.path, "rb") as file:  # it may be larger than the memory
            for line in file:
                try:
                    found = json.loads(line) if line.endswith(b"\n") else {}
                    written.append((found["image"], found.get("frame"), "error" in found))
                except (ValueError, KeyError):
                    break
                end += len(line)
        os.truncate(self.path, end)
        return written

    def take_up(self, task):
        """How many of the lines that are there already belong to `task`, and whether those are all
        of them; takes them off."""
        count = 0
        while self.written:
            image, frame, is_error = self.written[0]
            if image != task.path or frame is not None and not task.begin <= frame < task.end:
                if not task.end:
                    raise posevote.AlreadyExistsError(
                        f"'{self.path}' holds a line of '{image}' where one of '{task.path}' belongs:"
                        " it was made from other pictures; name another file, or use --restart"
                    )
                break
            self.written.popleft()
            count += 1
            if not task.end or is_error:
                return count, True
        return count, False

    def write(self, lines):
        if lines:
            self.file.write("".join(line + "\n" for line in lines).encode("utf-8", "replace"))
            self.file.flush()

    def close(self):
        os.fsync(self.file.fileno())
        self.file.close()
