"""Reads a data set with pycocotools: check_coco.py COCO NPZ, two data sets of one sweep.

Ids of images and annotations must be unique over train, val and test, and categories the same. Every box must contain the energy of its object, computed from the bins and the truth of the other data set, independently of the
program's pictures; and every mask must be inside its box."""

import glob
import json
import os
import sys

import numpy as np
from pycocotools.coco import COCO

MIN_SHARE = 0.99  # min share of an object's energy in its box


def places(ping, width, height):
    """Column and row of the centre of each bin in a fan, ahead up and port left."""
    reach = ping["range_m"][-1] + (ping["range_m"][1] - ping["range_m"][0]) / 2
    distance = height * ping["range_m"][None, :] / reach
    bearing = ping["bearings"][:, None]
    return width / 2 - 0.5 - distance * np.sin(bearing), height - 0.5 - distance * np.cos(bearing)


def main(coco_folder, npz_folder):
    worst, boxes, pictures = 1.0, 0, 0
    seen, categories = [], None
    for file in sorted(glob.glob(os.path.join(coco_folder, "instances_*.json"))):
        coco = COCO(file)
        seen += [("image", number) for number in coco.getImgIds()] + [("annotation", number) for number in coco.getAnnIds()]
        assert categories in (None, coco.cats), file
        categories = coco.cats
        for image in coco.loadImgs(coco.getImgIds()):
            pictures += 1
            assert os.path.exists(os.path.join(coco_folder, image["file_name"]))
            (name,) = glob.glob(os.path.join(npz_folder, f"{image['id']:06}_*.npz"))
            ping = np.load(name)
            objects = [str(text) for text in ping["objects"]]
            x, y = places(ping, image["width"], image["height"])
            for annotation in coco.loadAnns(coco.getAnnIds(image["id"])):
                left, top, width, height = annotation["bbox"]
                inside = (x > left - 1) & (x < left + width) & (y > top - 1) & (y < top + height)
                of_object = ping["object"] == objects.index(annotation["object"])
                energy = np.where(of_object, ping["bins"].astype(float) * ping["share"], 0)
                worst = min(worst, energy[inside].sum() / energy.sum())
                mask = coco.annToMask(annotation).astype(bool)
                rows, columns = np.where(mask)
                assert mask.sum() == annotation["area"], annotation
                assert rows.min() >= top and rows.max() < top + height, annotation
                assert columns.min() >= left and columns.max() < left + width, annotation
                boxes += 1
    assert len(seen) == len(set(seen)) == pictures + boxes
    print(json.dumps({"pictures": pictures, "boxes": boxes, "worst": worst}))
    assert worst >= MIN_SHARE, worst


main(*sys.argv[1:])
