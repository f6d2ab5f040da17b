"""Teach an object by background difference into a database and find it in a picture.

    python3 teach_and_recognize.py DATABASE NAME PICTURE BACKGROUND SCENE
"""

import sys

import posevote


def main(database, name, picture, background, scene):
    try:
        with posevote.ObjectStore(database) as store:
            added = store.teach(name, picture, background=background, yaw_deg=0)
            print(f"{name}: view {added.id}", "added" if added.added else "was there already")
            recognizer = posevote.Recognizer(store)
        result = recognizer.recognize(posevote.read_image(scene))
    except posevote.Error as error:  # one sentence that says what to do
        print(error, file=sys.stderr)
        return 1
    for found in result:
        x, y, width, height = found.box
        print(
            f"{found.object}: confidence {found.confidence:.2f}, {found.inliers} inliers, "
            f"{width:.0f} x {height:.0f} px at ({x:.0f}, {y:.0f})"
        )
    print(f"{result.counts.features} features in {result.time_ms.total:.0f} ms")
    return 0 if len(result) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
