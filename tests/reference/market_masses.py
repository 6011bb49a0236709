# SPDX-License-Identifier: MIT
"""Writes mass-market-dev.csv and mass-market-sealed.csv from two market places' listings.

    market_masses.py FOLDER AMAZON.csv TOYS.csv [TOYS.csv ...]

AMAZON.csv: PromptCloud's sample of Amazon.com listings of January 2020 (columns "Product Name", "Category",
"Product Specification", "Product Dimensions", "Asin", "Uniq Id"). TOYS.csv: PromptCloud's toys on Amazon.co.uk, cut by
categories (columns product_id, product_name, product_information, category, subcategory_1 to 4). README.md says where
to download them. Nobody chooses: every listing that states three sides and a mass is taken, in the order of the
SHA-256 of its id, at most nine of a shelf; README.md lists what is left out.
"""

import csv
import hashlib
import math
import pathlib
import re
import sys

from check_mass_held_out import COLUMNS, half_of

OUNCE, POUND, INCH = 0.028349523125, 0.45359237, 0.0254
MOST_OF_A_SHELF, LONGEST_NAME = 9, 60
BELIEVABLE = (15, 3000)  # kg per cubic metre of box: lighter and heavier goods have wrong data
SEVERAL = re.compile(
    r"\b(pack of|set of|lot of|bundle|\d+[- ]?(pack|pcs|pieces? (?!puzzle|jigsaw))|assorted|\(\d+ ?(count|pack|pcs))"
    r"|^\d+ x "
)
SOURCES = {
    "amazon": (
        "Amazon.com listing of January 2020 (PromptCloud sample), seller's data; "
        "ycnliu/ecommerce-rag-pipeline@0a5b2d0 data/test_sample_1000.csv",
        "facts",
    ),
    "toyuk": (
        "Amazon.co.uk listing of about 2015 (PromptCloud, toy products on Amazon), seller's data; "
        "carlosicc/src-asistente-virtual-ecommerce@cfef6a6 dataset/subset_productos_por_categoria_*.csv",
        "CC BY-SA 4.0",
    ),
}

# Shelf of the shop → our words for its goods.
SHELVES = {
    "3-D Puzzles": "puzzle; toy",
    "Action Figures": "action figure; toy",
    "Adults": "costume; clothing",
    "Airplane & Jet Kits": "model aircraft; model kit",
    "Art Sand": "play sand; craft kit",
    "Arts & Crafts": "craft kit; toy",
    "Baby & Toddler Toys": "baby toy; toy",
    "Balloons": "balloon; party supply",
    "Banners": "banner; party decoration",
    "Beach Toys": "beach toy; toy",
    "Bed Blankets": "blanket; bedding",
    "Birthday Candles": "birthday candle; candle",
    "Blackboards": "blackboard; toy",
    "Blankets & Throws": "blanket; bedding",
    "Board Games": "board game; game",
    "Bobbleheads": "bobblehead; figurine",
    "Bobbleheads & Busts": "bobblehead; figurine",
    "Bracelets": "bracelet; jewellery",
    "Brain Teasers": "brain teaser; puzzle",
    "Building Sets": "building set; toy",
    "Building Toys": "building set; toy",
    "Buttons & Pins": "button badge; badge",
    "Cake Toppers": "cake topper; party decoration",
    "Card Games": "card game; game",
    "Cars": "radio control car; toy car",
    "Chess": "chess set; game",
    "Children's Chalk": "chalk; art supply",
    "Children's Craft Kits": "craft kit; toy",
    "Clay & Dough": "modelling clay; craft kit",
    "Climbing Frames": "climbing frame; playground equipment",
    "Collectible Figures & Accessories": "figurine; collectible",
    "Collectible Props & Memorabilia": "collectible; toy",
    "Colouring Pencils": "coloured pencils; pencil set",
    "Colouring Pens & Markers": "marker set; markers",
    "Comforter Sets": "comforter; bedding",
    "Construction Paper": "paper; stationery",
    "Costumes": "costume; clothing",
    "Counting & Math Toys": "educational toy; toy",
    "Cowboys & Indians": "toy figure; toy",
    "Craft Kit": "craft kit; toy",
    "Craft Kits": "craft kit; toy",
    "DVD Games": "dvd game; game",
    "Darts & Accessories": "darts game; game",
    "Desk Supplies Organisers": "desk organiser; stationery",
    "Diaries, Journals & Notebooks": "notebook; stationery",
    "Dice & Dice Games": "dice game; game",
    "Die-Cast Vehicles": "die cast car; toy vehicle",
    "Dinosaurs": "toy dinosaur; toy figure",
    "Display Cases": "display case; case",
    "Doll Accessories": "doll accessory; toy",
    "Dolls": "doll; toy",
    "Dolls' House Accessories": "dollhouse accessory; toy",
    "Dominoes & Tile Games": "dominoes; game",
    "Educational Games": "educational game; game",
    "Electronic Learning Toys": "electronic toy; toy",
    "Erasers": "eraser; stationery",
    "Farm & Animals": "toy animal; toy figure",
    "Fashion Dolls": "fashion doll; doll",
    "Finger Puppets": "finger puppet; puppet",
    "Flash Cards": "flash cards; cards",
    "Floor Puzzles": "floor puzzle; puzzle",
    "Games & Accessories": "game; toy",
    "Garden": "toy; toy",
    "Garden Tools": "toy garden tool; toy",
    "Guitars & Strings": "toy guitar; musical toy",
    "Hand Puppets": "hand puppet; puppet",
    "Handheld Games": "handheld game; electronic toy",
    "Hats": "hat; clothing",
    "Headwear": "hat; clothing",
    "Helicopters & Quadcopters": "radio control helicopter; drone",
    "Invitations": "invitation cards; cards",
    "Jewelry": "jewelry craft kit; craft kit",
    "Jigsaw Puzzles": "jigsaw puzzle; puzzle",
    "Jigsaws": "jigsaw puzzle; puzzle",
    "Keychains": "keychain; accessory",
    "Kids Remote & App Controlled Toys": "radio control car; toy car",
    "Kids' Electronics": "electronic toy; toy",
    "Kites": "kite; toy",
    "Kites & Flight Toys": "kite; toy",
    "Knights & Castles": "toy figure; toy",
    "Learning & Education": "educational toy; toy",
    "Lunch Boxes": "lunch box; food container",
    "Masks": "mask; costume",
    "Military": "toy soldier; toy figure",
    "Miniatures": "miniature; toy",
    "Model Kits": "model kit; toy",
    "Money Banks": "money bank; novelty toy",
    "Musical Instruments": "toy musical instrument; musical toy",
    "Musical Toys": "musical toy; toy",
    "Novelty & Gag Toys": "novelty toy; toy",
    "Packs & Sets": "trading cards; card game",
    "Paddling Pools": "paddling pool; inflatable",
    "Painting By Numbers": "painting set; craft kit",
    "Paper & Stickers": "craft paper; paper",
    "Parts & Accessories": "model part; spare part",
    "Party Favors": "party favor; party supply",
    "Party Favours": "party favor; party supply",
    "Party Packs": "party supply",
    "Party Supplies": "party supply",
    "Pianos & Keyboards": "toy keyboard; musical toy",
    "Pirates": "toy figure; toy",
    "Play & Swing Sets": "swing set; playground equipment",
    "Play Food": "toy food; pretend play toy",
    "Play Tents & Tunnels": "play tent; tent",
    "Playsets": "playset; toy",
    "Plush Figures": "plush toy; toy",
    "Plush Pillows": "plush pillow; pillow",
    "Plush Puppets": "hand puppet; puppet",
    "Poker Sets": "poker set; game",
    "Pools & Water Toys": "water toy; toy",
    "Pretend Play": "pretend play toy; toy",
    "Quadcopters & Multirotors": "drone; quadcopter",
    "Race Tracks": "race track; toy",
    "Rattles": "rattle; baby toy",
    "Remote & App Controlled Vehicle Parts": "model car part; spare part",
    "Ride-On Toys & Accessories": "ride on toy; toy",
    "Robots": "toy robot; toy",
    "Rocking Horses": "rocking horse; ride on toy",
    "Science Fiction & Fantasy": "toy figure; toy",
    "Science Kits & Toys": "science kit; toy",
    "Shops & Accessories": "toy shop; pretend play toy",
    "Slot Cars": "slot car; toy car",
    "Soft Dolls": "soft doll; doll",
    "Sorting & Stacking Toys": "stacking toy; baby toy",
    "Sorting, Stacking & Plugging Toys": "stacking toy; baby toy",
    "Sound Toys": "musical toy; toy",
    "Spinning Tops": "spinning top; toy",
    "Sport": "toy figure; toy",
    "Standard Playing Card Decks": "playing cards; card game",
    "Statues": "statue; figurine",
    "Statues, Bobbleheads & Busts": "figurine; collectible",
    "Stickers": "sticker sheet; stickers",
    "Stuffed Animals & Plush Toys": "stuffed animal; plush toy",
    "Stuffed Animals & Teddy Bears": "stuffed animal; plush toy",
    "Tabletop & Miniature Gaming": "miniature; game",
    "Tanks": "model tank; model kit",
    "Teaching Clocks": "toy clock; educational toy",
    "Temporary Tattoos": "temporary tattoo sheet; stickers",
    "Toy Cars & Trucks": "toy car; toy vehicle",
    "Toy Chests & Storage": "toy box; storage box",
    "Toy Trains & Sets": "toy train; toy",
    "Toy Vehicle Playsets": "toy vehicle playset; playset",
    "Toy Vehicles": "toy vehicle; toy",
    "Toys": "toy",
    "Train Sets": "toy train set; toy train",
    "Trains": "model train; toy train",
    "Trivia & Quiz Games": "board game; game",
    "Trucks": "radio control truck; toy car",
    "Vehicle Playsets": "toy vehicle playset; playset",
    "Vehicles": "model vehicle; model",
    "Wall Plaques": "wall plaque; wall decoration",
    "Wind & Brass": "toy wind instrument; musical toy",
}


def amazon(path):
    with open(path, encoding="utf-8", errors="replace", newline="") as file:
        for row in csv.DictReader(file):
            text = f"{row['Product Specification'] or ''}|{row['Product Dimensions'] or ''}"
            sides = re.search(r"ProductDimensions:([\d.]+)x([\d.]+)x([\d.]+)inches", text)
            weight = re.search(r"ItemWeight:([\d.]+)(ounces|pounds)", text)
            if sides and weight:
                yield {
                    "id": f"amazon:{row['Asin'] or row['Uniq Id'][:12]}",
                    "title": row["Product Name"],
                    "shelves": [shelf.strip() for shelf in row["Category"].split(" | ")],
                    "sides": [float(side) * INCH for side in sides.groups()],
                    "mass": float(weight[1]) * (OUNCE if weight[2] == "ounces" else POUND),
                }


def toys(paths):
    seen = set()
    for path in paths:
        with open(path, encoding="utf-8", errors="replace", newline="") as file:
            for row in csv.DictReader(file):
                text = row["product_information"] or ""
                sides = re.search(r"Product Dimensions\s*([\d.]+)\s*x\s*([\d.]+)\s*x\s*([\d.]+)\s*(cm|m)\b", text)
                weight = re.search(r"Item Weight\s*([\d.,]+)\s*(Kg|g)\b", text, re.IGNORECASE)
                if not sides or not weight or row["product_id"] in seen:
                    continue
                seen.add(row["product_id"])
                yield {
                    "id": f"toyuk:{row['product_id'][:12]}",
                    "title": row["product_name"],
                    "shelves": [row["category"], *(row[f"subcategory_{level}"] for level in range(1, 5))],
                    "sides": [float(side) * (0.01 if sides[4] == "cm" else 1) for side in sides.groups()[:3]],
                    "mass": float(weight[1].replace(",", "")) * (1 if weight[2].lower() == "kg" else 0.001),
                }


def is_left_out(item):
    volume = math.prod(item["sides"])
    is_believable = volume > 0 and BELIEVABLE[0] <= item["mass"] / volume <= BELIEVABLE[1]
    return SEVERAL.search(item["title"].lower()) or not is_believable or min(item["sides"]) < 0.0009


def name_of(title):
    name = re.sub(r"\s+", " ", re.sub(r"[^\x20-\x7e]", " ", title)).strip().lower()
    if len(name) > LONGEST_NAME:
        name = name[:LONGEST_NAME].rsplit(" ", 1)[0]
    return name.strip(" ,-|(")


def main():
    folder, amazon_path, *toy_paths = map(pathlib.Path, sys.argv[1:])
    csv.field_size_limit(10**9)
    items = [*amazon(amazon_path), *toys(toy_paths)]
    items.sort(key=lambda item: hashlib.sha256(item["id"].encode()).digest())
    rows, of_shelf, names = {"dev": [], "sealed": []}, {}, set()
    for item in items:
        shelf = next((shelf for shelf in reversed(item["shelves"]) if shelf in SHELVES), None)
        name = name_of(item["title"])
        if shelf is None or is_left_out(item) or name in names or len(name) < 4:
            continue
        words = SHELVES[shelf]
        if of_shelf.setdefault(words, 0) >= MOST_OF_A_SHELF:
            continue
        of_shelf[words] += 1
        names.add(name)
        source, licence = SOURCES[item["id"].split(":")[0]]
        numbers = [f"{number:.4g}" for number in item["sides"]]
        note = "box and mass may be of the packed item"
        row = [item["id"], name, words, *numbers, "", "", f"{item['mass']:.4g}", "packaged item", source, licence, note]
        rows[half_of(item["id"])].append(row)
    for half, of_half in rows.items():
        with open(folder / f"mass-market-{half}.csv", "w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(COLUMNS)
            writer.writerows(sorted(of_half))
        print(f"{half}: {len(of_half)} objects")


if __name__ == "__main__":
    main()
