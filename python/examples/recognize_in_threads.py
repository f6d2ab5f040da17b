"""A folder of pictures, several at a time: one recogniser serves all threads.

    python3 recognize_in_threads.py OBJECT.jpg FOLDER > found.jsonl
"""

import json
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import posevote


def main(object_file, folder):
    view = posevote.teach_view(object_file)
    # Each picture is one thread's work, so that the single steps need no threads of their own.
    recognizer = posevote.Recognizer({Path(object_file).stem: [view]}, feature_surf_threads=1)

    def look(path):
        try:
            return recognizer.recognize(posevote.read_image(path)).to_dict(str(path))
        except posevote.UnreadableImageError as error:
            return {"image": str(path), "error": str(error)}

    with ThreadPoolExecutor() as threads:
        for line in threads.map(look, sorted(Path(folder).glob("*.jpg"))):
            print(json.dumps(line))
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
