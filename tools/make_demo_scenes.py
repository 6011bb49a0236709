#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the demo scenes that are made of formulas into data/scenes: a house of cards, a pool table, a spiral of dominoes, a wrecking
ball, Newton's cradle, a trampoline, plates that break, a basin with tap and drain, tongues of sheet metal, an awning
under a tap, beach balls, ice that melts, paper that tears, wires. The others there were built by hand.

Usage: make_demo_scenes.py [FOLDER]
"""
import json
import math
import pathlib
import random
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def turn(axis: list, degrees: float) -> dict:
    return {"axis": axis, "degrees": degrees}


def box(name: str, half: list, position: list, color: list, rotation: dict | None = None, **more) -> dict:
    pose = {"position": [round(each, 6) for each in position], **({"rotation": rotation} if rotation else {})}
    return {"name": name, "shape": {"type": "box", "half_extents": half}, "pose": pose, "color": color, **more}


def sphere(name: str, radius: float, position: list, color: list, **more) -> dict:
    return {"name": name, "shape": {"type": "sphere", "radius": radius}, "pose": {"position": [round(each, 6) for each in position]}, "color": color, **more}


def fixed(name: str, half: list, position: list, color: list, rotation: dict | None = None, **attributes) -> dict:
    return box(name, half, position, color, rotation, locked=True, category="room", attributes={"kind": "static", **attributes})


def hue(part: float, light: float = 0.55) -> list:
    """A colour of the wheel, 0 … 1."""
    return [round(light + 0.35 * math.cos(2 * math.pi * (part - shift / 3)), 3) for shift in range(3)]


def scene(title: str, description: str, camera: list, target: list, entities: list, **more) -> dict:
    for number, entity in enumerate(entities):
        entity["index"] = number + 1
    return {"embody_scene": 1, "title": title, "description": description, "camera": {"position": camera, "target": target}, "entities": entities, **more}


def card_house(storeys: int = 4) -> dict:
    """Boards, 56 cm square and 8 mm thick, of 0.55 g/cm³, leaning on each other at 18 degrees."""
    length, half_thick, lean = 0.56, 0.004, math.radians(18)
    rough = {"density": 550, "friction_static": 0.55, "friction_dynamic": 0.5, "restitution": 0.05}
    # A leaning board stands on its lower edge; its upper edge meets the other one's.
    reach = length * math.sin(lean) + 2 * half_thick * math.cos(lean)
    height = length * math.cos(lean) + 2 * half_thick * math.sin(lean)
    pitch = 2 * reach + 0.002
    entities = [fixed("Floor", [3, 0.1, 2.5], [0, -0.1, 0], [0.36, 0.24, 0.15], friction_static=0.6, friction_dynamic=0.55)]
    for storey in range(storeys):
        floor = storey * (height + 2 * half_thick + 0.0002) + 0.0001
        count = storeys - storey
        for tent in range(count):
            x = (tent - (count - 1) / 2) * pitch
            for side in (-1, 1):
                centre = [x + side * (reach / 2 + 0.0001), floor + height / 2, 0]
                entities.append(box(f"Board {len(entities)}", [half_thick, length / 2, length / 2], centre, hue(len(entities) / 31, 0.6), turn([0, 0, 1], side * math.degrees(lean)), attributes=dict(rough)))
        for roof in range(count - 1):
            x = (roof - (count - 2) / 2) * pitch
            entities.append(box(f"Board {len(entities)}", [length / 2, half_thick, length / 2], [x, floor + height + half_thick + 0.0001, 0], hue(len(entities) / 31, 0.6), attributes=dict(rough)))
    start = [-2.6, 0.3, 0.1]
    entities.append(sphere("Ball", 0.11, start, [0.2, 0.35, 0.75], enabled=False, attributes={"mass": 0.6, "restitution": 0.6}))
    actions = [{"name": "Ball", "receiver": {"index": len(entities)}, "trigger": {"type": "signal", "button": "Ball"}, "effect": {"type": "spawn", "pose": {"position": start}, "linear_velocity": [7, 1.2, 0]}, "once": False}]
    return scene("House of cards", "A house of boards that only friction holds up. The button “Ball” throws one at it.", [1.7, 1.7, 3.9], [0, 0.95, 0], entities, actions=actions)


def pool_table() -> dict:
    """A table of 2.24 m × 1.12 m (8 feet), balls of 57.15 mm and 170 g; the cue ball has begun to roll."""
    radius, width, depth, bed = 0.028575, 1.12, 2.24, 0.03
    hole = 0.13
    felt, wood = [0.05, 0.36, 0.24], [0.35, 0.2, 0.1]
    cloth = {"friction_static": 0.2, "friction_dynamic": 0.2, "restitution": 0.5}
    entities = [fixed("Floor", [3, 0.1, 3], [0, -0.9, 0], [0.3, 0.24, 0.2])]
    half_w, half_d = width / 2, depth / 2
    # The bed leaves the corners and the middles of the long sides open.
    entities.append(fixed("Bed", [half_w - hole / 2, bed, half_d], [0, -bed, 0], felt, **cloth))
    for side in (-1, 1):
        for part in (-1, 1):
            long = (half_d - hole) / 2
            entities.append(fixed("Bed", [hole / 4, bed, long - hole / 4], [side * (half_w - hole / 4), -bed, part * (half_d / 2 + 0.0)], felt, **cloth))
    cushion = {"friction_static": 0.2, "friction_dynamic": 0.15, "restitution": 0.75}
    top = 0.06  # higher than real ones, so that no ball climbs over
    for side in (-1, 1):
        for part in (-1, 1):
            entities.append(fixed("Cushion", [0.03, top / 2, (half_d - 1.5 * hole) / 2], [side * (half_w + 0.03), top / 2, part * half_d / 2], [0.04, 0.3, 0.2], **cushion))
        entities.append(fixed("Cushion", [half_w - hole * 0.75, top / 2, 0.03], [0, top / 2, side * (half_d + 0.03)], [0.04, 0.3, 0.2], **cushion))
        entities.append(fixed("Rail", [0.05, 0.135, half_d + 0.16], [side * (half_w + 0.11), -0.075, 0], wood))
        entities.append(fixed("Rail", [half_w + 0.06, 0.135, 0.05], [0, -0.075, side * (half_d + 0.11)], wood))
    entities.append(fixed("Tray", [half_w + 0.16, 0.01, half_d + 0.16], [0, -0.2, 0], [0.12, 0.08, 0.05], friction_static=0.5, friction_dynamic=0.5))
    ball = {"mass": 0.17, "friction_static": 0.06, "friction_dynamic": 0.06, "restitution": 0.93, "angular_damping": 0.4}
    # A rack is never tight; with even gaps the blow would run through it as in Newton's cradle.
    chance = random.Random(7)
    loose = 0.003
    row_gap = (2 * radius + loose) * math.sqrt(3) / 2
    number = 0
    for row in range(5):
        for place in range(row + 1):
            number += 1
            x = (place - row / 2) * (2 * radius + loose) + chance.uniform(-1, 1) * loose / 3
            z = -half_d / 2 - row * row_gap + chance.uniform(-1, 1) * loose / 3
            entities.append(sphere(f"Ball {number}", radius, [x, radius, z], hue(number / 15), attributes=dict(ball)))
    cue = sphere("Cue ball", radius, [0.012, radius, half_d / 2], [0.95, 0.93, 0.88], attributes=dict(ball))
    cue["linear_velocity"] = [0, 0, -9]
    entities.append(cue)
    # The floor is at zero, the cloth 0.8 m above it.
    for entity in entities:
        entity["pose"]["position"][1] = round(entity["pose"]["position"][1] + 0.8, 6)
    return scene("Pool table", "The break: the white ball comes with 9 m/s. Balls and cloth have the measures and the friction of real ones.", [1.7, 2.3, 1.9], [0, 0.8, -0.2], entities)


def domino_spiral(turns: float = 3.2) -> dict:
    """Dominoes of the usual proportions (48 × 24 × 7.5 mm) five times as large, 0.55 of their height apart."""
    half = [0.019, 0.12, 0.06]
    gap, inner, pitch = 0.13, 0.55, 0.3
    entities = [fixed("Floor", [3, 0.1, 3], [0, -0.1, 0], [0.4, 0.41, 0.43])]
    angle, number = 0.0, 0
    places = []
    while angle < 2 * math.pi * turns:
        r = inner + pitch * angle / (2 * math.pi)
        places.append((r, angle))
        angle += gap / r
    for r, angle in reversed(places):
        number += 1
        x, z = r * math.cos(angle), r * math.sin(angle)
        # The thin side looks along the path.
        entities.append(box(f"Domino {number}", half, [x, half[1], z], hue(number / len(places)), turn([0, 1, 0], -math.degrees(angle) - 90), category="domino",
                            attributes={"density": 700, "restitution": 0.05, "friction_static": 0.35, "friction_dynamic": 0.3}))
    first = entities[1]
    r, angle = places[-1]
    # It turns about its lower edge, inwards along the path.
    spin = 2.2
    first["angular_velocity"] = [round(-spin * math.cos(angle), 6), 0, round(-spin * math.sin(angle), 6)]
    first["linear_velocity"] = [round(spin * half[1] * math.sin(angle), 6), 0, round(-spin * half[1] * math.cos(angle), 6)]
    return scene("Spiral of dominoes", f"{number} dominoes; the outermost is pushed.", [0.2, 2.6, 3.1], [0, 0, 0.15], entities)


def wrecking_ball() -> dict:
    """A ball of 250 kg on a chain of 8 links against a wall of 96 bricks."""
    brick = {"density": 1800, "friction_static": 0.6, "friction_dynamic": 0.5, "restitution": 0.05}
    entities = [fixed("Ground", [8, 0.1, 5], [0, -0.1, 0], [0.38, 0.37, 0.33])]
    for row in range(12):
        for place in range(8):
            z = (place - 3.5 + (0.25 if row % 2 else -0.25)) * 0.402
            entities.append(box(f"Brick {len(entities)}", [0.1, 0.1, 0.2], [1.2, 0.1 + 0.2 * row, z], [round(0.5 + 0.06 * ((row + place) % 3), 3), 0.24, 0.17], attributes=dict(brick)))
    pivot, links, link = [0, 4.6, 0], 8, 0.36
    lean = math.radians(68)
    along = [-math.sin(lean), -math.cos(lean), 0]
    at = lambda distance: [pivot[axis] + distance * along[axis] for axis in range(3)]
    entities.append(fixed("Crane", [0.12, 0.08, 3], [0, 4.7, 0], [0.75, 0.55, 0.1]))
    joints, last = [], None
    for number in range(links):
        index = len(entities) + 1
        entities.append({"name": f"Link {number + 1}", "shape": {"type": "capsule", "radius": 0.04, "half_height": link / 2 - 0.05}, "pose": {"position": [round(each, 6) for each in at((number + 0.5) * link)], "rotation": turn([0, 0, 1], -math.degrees(lean))},
                         "color": [0.3, 0.31, 0.33], "attributes": {"mass": 6}})
        joints.append({"name": f"link {number + 1}", "type": "ball", "entity_b": index, "anchor": [round(each, 6) for each in at(number * link)], **({"entity_a": last} if last else {})})
        last = index
    radius = 0.34
    entities.append(sphere("Ball", radius, at(links * link + radius), [0.16, 0.17, 0.19], attributes={"mass": 250, "restitution": 0.1}))
    joints.append({"name": "ball", "type": "ball", "entity_a": last, "entity_b": len(entities), "anchor": [round(each, 6) for each in at(links * link)]})
    return scene("Wrecking ball", "A quarter of a ton on a chain, and a wall of bricks.", [-4.6, 2.6, 6.4], [0.2, 1.6, 0], entities, joints=joints)


def newtons_cradle(count: int = 5) -> dict:
    """Steel balls that touch, on rods without mass worth mentioning; two are lifted."""
    radius, length, lifted = 0.05, 0.5, 2
    steel = {"mass": 4, "restitution": 0.98, "friction_static": 0, "friction_dynamic": 0, "linear_damping": 0, "angular_damping": 0}
    entities = [fixed("Base", [0.5, 0.03, 0.3], [0, -0.03, 0], [0.2, 0.15, 0.12]), fixed("Bar", [0.35, 0.012, 0.012], [0, 0.68, -0.16], [0.7, 0.7, 0.72]), fixed("Bar", [0.35, 0.012, 0.012], [0, 0.68, 0.16], [0.7, 0.7, 0.72])]
    for side in (-1, 1):
        for depth in (-1, 1):
            entities.append(fixed("Post", [0.012, 0.334, 0.012], [side * 0.338, 0.334, depth * 0.16], [0.7, 0.7, 0.72]))
    joints = []
    for number in range(count):
        x = (number - (count - 1) / 2) * (2 * radius + 0.0002)
        angle = math.radians(40) if number < lifted else 0
        position = [x - length * math.sin(angle), 0.668 - length * math.cos(angle), 0]
        entities.append(sphere(f"Ball {number + 1}", radius, position, [0.78, 0.79, 0.82], attributes=dict(steel)))
        joints.append({"name": f"thread {number + 1}", "type": "hinge", "entity_b": len(entities), "anchor": [round(x, 6), 0.668, 0], "axis": [0, 0, 1]})
    return scene("Newton's cradle", "As many balls leave on the other side as came.", [0.15, 0.55, 1.35], [0, 0.32, 0], entities, joints=joints)


def trampoline() -> dict:
    """A sheet that is held at its rim, and things that fall on it."""
    entities = [fixed("Floor", [4, 0.1, 4], [0, -0.1, 0], [0.33, 0.42, 0.3])]
    size, height = 1.1, 0.8
    for x in (-1, 1):
        for z in (-1, 1):
            entities.append(fixed("Leg", [0.03, height / 2, 0.03], [x * (size + 0.05), height / 2, z * (size + 0.05)], [0.3, 0.32, 0.36]))
    for side in (-1, 1):
        entities.append(fixed("Rim", [0.03, 0.03, size + 0.08], [side * (size + 0.05), height, 0], [0.2, 0.35, 0.7]))
        entities.append(fixed("Rim", [size + 0.08, 0.03, 0.03], [0, height, side * (size + 0.05)], [0.2, 0.35, 0.7]))
    steps = 12
    rim = [[-size + 2 * size * i / steps, 0, side * size] for i in range(steps + 1) for side in (-1, 1)] + [[side * size, 0, -size + 2 * size * i / steps] for i in range(1, steps) for side in (-1, 1)]
    pins = [{"position": [round(each, 6) for each in place], "radius": 0.1} for place in rim]
    entities.append(box("Sheet", [size, 0.003, size], [0, height, 0], [0.14, 0.15, 0.17], pins=pins, category="tarpaulin",
                        attributes={"kind": "cloth", "area_density": 0.6, "cloth_nodes": 900, "friction_static": 0.6, "friction_dynamic": 0.5}))
    for number, (x, y, z, radius) in enumerate([(0, 2.2, 0, 0.12), (0.35, 3, -0.2, 0.1), (-0.4, 3.7, 0.25, 0.14), (0.1, 4.5, 0.4, 0.09)]):
        entities.append(sphere(f"Ball {number + 1}", radius, [x, y, z], hue(number / 4), attributes={"density": 250, "restitution": 0.5}))
    return scene("Trampoline", "A sheet held at its rim, and balls that jump on it.", [3.1, 2.3, 3.6], [0, 1.1, 0], entities)


def breaking_plates() -> dict:
    """Porcelain plates, a pane of glass and a ball on a floor of tiles. A plate breaks above 0.5 N s, as a fall of 7 cm gives."""
    china = {"mass": 0.5, "friction_static": 0.45, "friction_dynamic": 0.35, "restitution": 0.3, "breaks": True, "break_impulse": 0.5, "fracture_energy": 25, "break_pieces": 16}
    glass = {"mass": 3.6, "friction_static": 0.5, "friction_dynamic": 0.4, "restitution": 0.3, "breaks": True, "break_impulse": 6, "fracture_energy": 8, "break_pieces": 32}
    entities = [{**fixed("Floor", [4, 0.1, 4], [0, -0.1, 0], [0.75, 0.72, 0.68], friction_static=0.5, friction_dynamic=0.4, restitution=0.3), "finish": "tiles"}]
    for number, (x, y, degrees) in enumerate([(-0.9, 0.9, 8), (-0.5, 1.4, 35), (-0.1, 1.9, 80)]):
        pose = {"position": [x, y, 0.3], "rotation": turn([0, 0, 1], degrees)}
        entities.append({"name": f"Plate {number + 1}", "shape": {"type": "cylinder", "radius": 0.13, "half_height": 0.006}, "pose": pose, "color": hue(number / 3), "attributes": dict(china)})
    # The pane stands in a groove of two posts.
    entities.append(box("Pane", [0.3, 0.4, 0.003], [0.9, 0.401, -0.3], [0.55, 0.75, 0.8], attributes=dict(glass)))
    for side in (-1, 1):
        for face in (-1, 1):
            entities.append(fixed("Post", [0.03, 0.4, 0.015], [0.9 + side * 0.3, 0.4, -0.3 + face * 0.019], [0.4, 0.28, 0.16]))
    entities.append(fixed("Wall", [4, 1, 0.1], [0, 1, -2], [0.85, 0.83, 0.8]))
    ball = sphere("Ball", 0.06, [0.85, 0.45, 2.2], [0.75, 0.2, 0.15], attributes={"mass": 1.5, "restitution": 0.3})
    ball["linear_velocity"] = [0, 2.2, -9]
    entities.append(ball)
    return scene("Breaking plates", "Plates fall on tiles, and a ball flies through a pane. Make one stronger (Breaking impulse) and play again.", [0.8, 1.0, 2.3], [0.05, 0.35, 0], entities)


def basin() -> dict:
    """A basin, 70 × 40 cm inside, that a tap fills with 50 litres in 10 s, and that a drain empties afterwards."""
    length, width, height, wall = 0.35, 0.2, 0.2, 0.025
    stone = [0.86, 0.85, 0.82]
    entities = [{**fixed("Floor", [2, 0.1, 2], [0, -0.1, 0], [0.55, 0.57, 0.6], friction_static=0.6, friction_dynamic=0.5), "finish": "tiles"}]
    top = 0.5
    entities.append(fixed("Stand", [0.3, (top - 2 * wall) / 2, 0.15], [0, (top - 2 * wall) / 2, 0], [0.5, 0.36, 0.22]))
    entities.append(fixed("Bottom", [length + 2 * wall, wall, width + 2 * wall], [0, top - wall, 0], stone))
    for side in (-1, 1):
        entities.append(fixed("Side", [wall, height, width + 2 * wall], [side * (length + wall), top + height, 0], stone))
        entities.append(fixed("Side", [length, height, wall], [0, top + height, side * (width + wall)], stone))
    # A column on the rim behind, whose spout reaches over the water.
    steel = {"kind": "static"}
    spout = [{"type": "cylinder", "radius": 0.022, "half_height": 0.11}, {"type": "box", "half_extents": [0.014, 0.014, 0.085], "position": [0, 0.098, 0.085]},
             {"type": "cylinder", "radius": 0.028, "half_height": 0.015, "position": [0, 0.08, 0.17]}, {"type": "box", "half_extents": [0.008, 0.005, 0.04], "position": [0, 0.118, -0.015]}]
    entities.append({"name": "Tap", "shape": {"type": "compound", "children": spout}, "pose": {"position": [-0.2, top + 2 * height + 0.11, -width - wall]}, "color": [0.6, 0.62, 0.65],
                     "locked": True, "attributes": steel, "tap": {"litres_per_minute": 300, "radius": 0.025, "position": [0, 0.045, 0.17]}})
    entities.append({"name": "Drain", "shape": {"type": "cylinder", "radius": 0.045, "half_height": 0.003}, "pose": {"position": [0.2, top + 0.003, 0]}, "color": [0.1, 0.1, 0.11],
                     "locked": True, "attributes": steel, "drain": {"radius": 0.06, "open": False}})
    entities.append(box("Water", [length, 0.125, width], [0, top + 0.125, 0], [0.6, 0.8, 0.9], starts_empty=True, attributes={"kind": "fluid", "particle_budget": 8000}))
    for number, (x, z, radius) in enumerate([(0.05, 0.08, 0.05), (0.18, -0.08, 0.06), (-0.1, 0.1, 0.045)]):
        entities.append(sphere(f"Ball {number + 1}", radius, [x, top + radius + 0.001, z], hue(number / 3), attributes={"density": 150, "restitution": 0.3}))
    entities.append(box("Block", [0.05, 0.04, 0.06], [-0.22, top + 0.041, 0.08], [0.72, 0.52, 0.3], attributes={"density": 550}))
    tap, drain = (next(number + 1 for number, each in enumerate(entities) if each["name"] == name) for name in ("Tap", "Drain"))
    timed = [("shut the tap", 10, tap, False), ("pull the plug", 14, drain, True)]
    actions = [{"name": name, "trigger": {"type": "time", "time": time}, "receiver": {"index": receiver}, "effect": {"type": "set_open", "open": is_open}} for name, time, receiver, is_open in timed]
    actions += [{"name": name, "trigger": {"type": "signal", "button": name}, "receiver": {"index": receiver}, "effect": {"type": "set_open", "open": is_open}, "once": False}
                for name, receiver, is_open in (("Tap on", tap, True), ("Tap off", tap, False), ("Plug out", drain, True), ("Plug in", drain, False))]
    return scene("Tap and drain", "A tap fills a basin, and toys rise with the water. After 14 s a drain empties it. Four buttons open and shut both.", [0.75, 1.95, 1.0], [0, 0.72, 0], entities, actions=actions)


def sheet_metal() -> dict:
    """Two tongues of steel of 0.8 mm, held at one end, and a ball of 3 kg that falls on each: spring steel throws it back, soft steel stays bent.

    E t3 / 12 (1 - nu2) = 9.4 N m at 200 GPa; soft steel yields at 2 * 250 MPa / 200 GPa / 0.8 mm = 3.1 1/m. The stretch stiffness is less than E t,
    160 MN/m, since nothing here stretches the sheets."""
    height, length, width = 0.7, 0.3, 0.15
    entities = [fixed("Floor", [4, 0.1, 4], [0, -0.1, 0], [0.6, 0.6, 0.62])]
    for side, name, color, limit in ((-1, "Spring steel", [0.45, 0.52, 0.62], {}), (1, "Soft steel", [0.66, 0.64, 0.6], {"bend_yield": 3.1})):
        z = side * 0.3
        entities.append(fixed("Clamp", [0.05, height / 2 - 0.001, width + 0.02], [-length + 0.02, height / 2 - 0.001, z], [0.3, 0.32, 0.36]))
        pins = [{"position": [round(x, 6), 0, round(width * step / 3, 6)], "radius": 0.035} for x in (-length, -length + 0.05) for step in range(-3, 4)]
        entities.append(box(name, [length, 0.0004, width], [0, height, z], color, pins=pins, category="sheet metal",
                            attributes={"kind": "cloth", "area_density": 6.3, "thickness": 0.0008, "stretch_stiffness": 1e5, "shear_stiffness": 1e5, "bend_stiffness": 9.4,
                                        "bend_friction": 0, "cloth_nodes": 250, "friction_static": 0.3, "friction_dynamic": 0.25, **limit}))
        entities.append(sphere("Ball", 0.045, [0.2, height + 0.6, z], hue(side / 4), attributes={"mass": 3, "restitution": 0.3}))
    return scene("Sheet metal", "A ball falls on two tongues of steel: one springs back, the other stays bent. The difference is the Fold limit in the panel.", [1.1, 1.25, 1.5], [0, 0.6, 0], entities)


def torn_paper() -> dict:
    """A ball of 4 kg is thrown at a sheet of tissue paper and at one of cotton, each held at its four sides: one tears, the other catches it.

    Creped tissue paper of 30 g/m2 bears 0.5 kN/m at a strain of 10 % (ISO 12625-4) and takes 1 J for a metre of tear; cotton of 200 g/m2 bears 12 kN/m (EN ISO 13934-1, 600 N for 5 cm)
    and takes 20 J/m, twice the 10 N that tear trousers of it (ISO 13937-2)."""
    half, height, bar = 0.4, 0.65, 0.02
    wood = [0.5, 0.36, 0.22]
    entities = [{**fixed("Floor", [2, 0.1, 4], [0, -0.1, 0], [0.6, 0.6, 0.62], friction_static=0.6, friction_dynamic=0.5), "finish": "concrete"}]
    papers = {"area_density": 0.03, "thickness": 0.0001, "stretch_stiffness": 5e3, "shear_stiffness": 2e3, "bend_stiffness": 2e-5, "bend_yield": 60, "tear_strength": 500, "tear_energy": 1}
    cottons = {"area_density": 0.2, "thickness": 0.0004, "stretch_stiffness": 1.5e4, "shear_stiffness": 2e3, "bend_stiffness": 1e-5, "tear_strength": 12000, "tear_energy": 20}
    for name, x, color, weave in (("Tissue paper", -0.5, [0.95, 0.93, 0.86], papers), ("Cotton", 0.5, [0.55, 0.66, 0.8], cottons)):
        for side in (-1, 1):
            entities.append(fixed("Frame", [bar, height / 2 + half, bar], [x + side * (half + bar), height / 2 + half, -0.03], wood))
            entities.append(fixed("Frame", [half, bar, bar], [x, height + half + side * (half - bar), -0.03 - 2 * bar], wood))
        steps = [round(-half + 2 * half * k / 16, 6) for k in range(17)]
        pins = [{"position": [across, side * half, 0], "radius": 0.03} for side in (-1, 1) for across in steps]
        pins += [{"position": [side * half, across, 0], "radius": 0.03} for side in (-1, 1) for across in steps[1:-1]]
        entities.append(box(name, [half, half, 0.0002], [x, height + half, 0], color, pins=pins, category="cloth",
                            attributes={"kind": "cloth", "cloth_nodes": 450, "friction_static": 0.4, "friction_dynamic": 0.35, **weave}))
        ball = sphere("Ball", 0.09, [x, height + half + 0.05, 1.2], [0.75, 0.3, 0.22], attributes={"mass": 4, "friction_static": 0.5, "friction_dynamic": 0.4, "friction_rolling": 0.025})
        ball["linear_velocity"] = [0, 1.2, -5]
        entities.append(ball)
    return scene("Torn paper", "A ball is thrown at a sheet of paper and at one of cotton. Tear strength and Tear energy in the panel make the difference.", [1.15, 1.75, 2.3], [0, 0.9, -0.2], entities)


def wires() -> dict:
    """Two steel wires of 3 mm, clamped at one end, with a ball of 0.3 kg at the other that is taken away after 4 s: spring steel goes back, soft steel stays bent.

    E pi d4 / 64 = 0.8 N m2 at 200 GPa; soft steel flows at 250 MPa * d3 / 6 / 0.8 N m2 = 1.4 1/m. EA is less than 1.4 MN, since nothing here stretches the wires."""
    height, half = 0.7, 0.25
    entities = [fixed("Floor", [3, 0.1, 3], [0, -0.1, 0], [0.6, 0.6, 0.62]), fixed("Clamp", [0.05, height / 2 + 0.02, 0.35], [-half - 0.05, height / 2 + 0.02, 0], [0.3, 0.32, 0.36])]
    actions = []
    for z, name, color, limit in ((-0.2, "Spring steel", [0.13, 0.22, 0.5], {}), (0.2, "Soft steel", [0.7, 0.26, 0.1], {"bend_yield": 1.4})):
        entities.append(sphere("Ball", 0.025, [half, height, z], hue(z), attributes={"mass": 0.3, "restitution": 0}))
        ball = len(entities)
        entities.append({"name": name, "shape": {"type": "capsule", "radius": 0.0015, "half_height": half}, "color": color, "category": "wire",
                         "pose": {"position": [0, height, z], "rotation": turn([0, 0, 1], 90)},
                         "pins": [{"position": [0, half, 0], "radius": 0.012, "clamped": True}, {"position": [0, -half, 0], "radius": 0.012, "to": ball}],
                         "attributes": {"kind": "rope", "linear_density": 0.055, "axial_stiffness": 1e5, "bend_rigidity": 0.8, "rope_segments": 25, "damping_rayleigh": 0.05, **limit}})
        actions.append({"name": "take the ball away", "trigger": {"type": "time", "time": 4}, "receiver": {"index": ball}, "effect": {"type": "remove"}})
    return scene("Wires", "A ball bends each of two steel wires and is taken away after 4 s. Spring steel goes back, soft steel stays bent. The difference is the Fold limit in the panel.",
                 [0.45, 0.85, 0.85], [-0.02, 0.56, 0], entities, actions=actions)


def awning() -> dict:
    """A cloth between four posts over a tub, on which a tap pours 8 litres in 8 s: they gather in its sag and drip through."""
    half, height, tub, rim, wall = 0.4, 0.9, 0.22, 0.1, 0.02
    clay, wood = [0.72, 0.42, 0.3], [0.5, 0.36, 0.22]
    entities = [{**fixed("Floor", [2, 0.1, 2], [0, -0.1, 0], [0.5, 0.55, 0.48], friction_static=0.6, friction_dynamic=0.5), "finish": "tiles"}]
    for side in (-1, 1):
        entities.append(fixed("Tub", [wall, rim, tub + 2 * wall], [side * (tub + wall), rim, 0], clay))
        entities.append(fixed("Tub", [tub, rim, wall], [0, rim, side * (tub + wall)], clay))
        for back in (-1, 1):
            entities.append(fixed("Post", [0.015, height / 2, 0.015], [side * (half + 0.015), height / 2, back * (half + 0.015)], wood))
    pins = [{"position": [x * half, 0, z * half], "radius": 0.06} for x in (-1, 1) for z in (-1, 1)]
    entities.append(box("Cloth", [half, 0.0004, half], [0, height, 0], [0.86, 0.8, 0.62], pins=pins, category="cloth", attributes={"kind": "cloth", "area_density": 0.25, "cloth_nodes": 260}))
    pipe = [{"type": "cylinder", "radius": 0.02, "half_height": 0.35}, {"type": "box", "half_extents": [0.014, 0.014, 0.2], "position": [0, 0.34, 0.2]},
            {"type": "cylinder", "radius": 0.026, "half_height": 0.015, "position": [0, 0.32, 0.4]}]
    entities.append({"name": "Tap", "shape": {"type": "compound", "children": pipe}, "pose": {"position": [0, height, -half - 0.1]}, "color": [0.6, 0.62, 0.65], "locked": True,
                     "attributes": {"kind": "static"}, "tap": {"litres_per_minute": 60, "radius": 0.025, "position": [0, 0.28, 0.4]}})
    tap = len(entities)
    entities.append(box("Water", [tub, 0.05, tub], [0, 0.05, 0], [0.6, 0.8, 0.9], starts_empty=True, attributes={"kind": "fluid", "particle_budget": 3000}))
    actions = [{"name": "shut the tap", "trigger": {"type": "time", "time": 8}, "receiver": {"index": tap}, "effect": {"type": "set_open", "open": False}}]
    actions += [{"name": name, "trigger": {"type": "signal", "button": name}, "receiver": {"index": tap}, "effect": {"type": "set_open", "open": is_open}, "once": False}
                for name, is_open in (("Tap on", True), ("Tap off", False))]
    return scene("Awning", "A tap pours water on a cloth. It gathers where the cloth sags, and drips through into the tub until the cloth is dry.", [0.55, 1.75, 1.75], [0, 0.55, 0], entities, actions=actions)


def beach_balls() -> dict:
    """An exercise ball and a tube, on which boxes fall, and beach balls. PVC of 15 to 30 MPa and 0.2 to 0.8 mm; 15 to 45 mbar, as makers say and mouths blow."""
    def film(mass: float, thickness: float, stiffness: float, pressure: float, nodes: int, damping: float = 0.001) -> dict:
        return {"kind": "cloth", "mass": mass, "thickness": thickness, "stretch_stiffness": stiffness, "shear_stiffness": 0.4 * stiffness, "bend_stiffness": 1e-5, "bend_friction": 0,
                "damping_rayleigh": damping, "friction_static": 0.6, "friction_dynamic": 0.5, "cloth_nodes": nodes, "internal_pressure": pressure}

    entities = [fixed("Floor", [4, 0.1, 4], [0, -0.1, 0], [0.6, 0.6, 0.62])]
    entities.append(sphere("Exercise ball", 0.32, [-0.5, 0.33, 0], [0.3, 0.45, 0.72], category="exercise ball", attributes=film(1.25, 0.0008, 12000, 4500, 240, 0.003)))
    big = len(entities)
    entities.append({"name": "Tube", "shape": {"type": "capsule", "radius": 0.15, "half_height": 0.45}, "pose": {"position": [0.5, 0.16, 0.1], "rotation": turn([1, 0, 0], 90)}, "color": [0.85, 0.6, 0.2],
                     "category": "air mattress", "attributes": film(0.5, 0.00035, 10000, 2500, 200, 0.003)})
    for number, (x, y, mass) in enumerate(((-0.5, 1.2, 6), (0.5, 0.9, 4))):
        entities.append(box(f"Box {number + 1}", [0.1, 0.08, 0.1], [x, y, 0.02], hue(number / 3), turn([0, 1, 0], 20 * number), attributes={"mass": mass, "restitution": 0}))
    entities += [sphere("Beach ball", 0.17, [x, y, z], color, category="beach ball", attributes=film(0.1, 0.0002, 6000, 1500, 120))
                 for x, y, z, color in ((0.05, 1.2, 0.5, [0.9, 0.35, 0.25]), (0.1, 1.6, -0.5, [0.95, 0.8, 0.3]))]
    actions = [{"name": name, "trigger": {"type": "signal", "button": name}, "receiver": {"index": big}, "effect": {"type": "set_attribute", "name": "internal_pressure", "value": pressure}, "once": False}
               for name, pressure in (("Pump", 9000), ("Let out", 100))]
    return scene("Beach balls", "Balls and a tube of closed cloth with gas inside (Internal pressure). Boxes fall on them. Buttons pump the big ball up and let its air out.", [1.5, 1.3, 1.9], [0, 0.35, 0], entities, actions=actions)


def melting_ice() -> dict:
    """Ice floats on the water of a dish, and a snowman stands in another one. After 3 s the ice melts into the water, whose level stays, after 5 s the snowman melts, after 9 s all of it freezes.

    The snowman's density is that of firn: it becomes as much liquid as it fills."""
    glass, white = [0.72, 0.83, 0.88], [0.93, 0.96, 1.0]
    top, half, rim, wall = 0.4, 0.16, 0.05, 0.008
    entities = [{**fixed("Floor", [2, 0.1, 2], [0, -0.1, 0], [0.6, 0.55, 0.5], friction_static=0.6, friction_dynamic=0.5), "finish": "parquet"},
                fixed("Table", [0.55, top / 2, 0.3], [0, top / 2 - 2 * wall, 0], [0.45, 0.32, 0.22])]
    for x in (-0.22, 0.22):
        entities.append(fixed("Dish", [half + 2 * wall, wall, half + 2 * wall], [x, top - wall, 0], glass))
        for side in (-1, 1):
            entities.append(fixed("Rim", [wall, rim, half + 2 * wall], [x + side * (half + wall), top + rim, 0], glass))
            entities.append(fixed("Rim", [half, rim, wall], [x, top + rim, side * (half + wall)], glass))
    entities.append(box("Water", [half, 0.035, half], [-0.22, top + 0.035, 0], [0.6, 0.8, 0.9], attributes={"kind": "fluid", "particle_budget": 7000}))
    water = len(entities)
    for number, (x, z, degrees) in enumerate([(-0.08, 0.06, 10), (0.05, 0.08, 35), (0.08, -0.05, 60), (-0.05, -0.07, 80)]):
        entities.append(box(f"Ice {number + 1}", [0.03, 0.03, 0.03], [-0.22 + x, top + 0.09, z], white, turn([0, 1, 0], degrees), attributes={"density": 917}))
    balls = [{"type": "sphere", "radius": radius, "position": [0, y, 0]} for radius, y in ((0.06, 0), (0.045, 0.09), (0.03, 0.155))]
    entities.append({"name": "Snowman", "shape": {"type": "compound", "children": balls}, "pose": {"position": [0.22, top + 0.061, 0]}, "color": white, "attributes": {"density": 550, "particle_budget": 3000}})
    snowman = len(entities)
    timed = [("melt the ice", 3, water + number, {"type": "melt", "into": water}) for number in range(1, 5)]
    timed += [("melt the snowman", 5, snowman, {"type": "melt"}), ("freeze the water", 9, water, {"type": "freeze"})]
    actions = [{"name": name, "trigger": {"type": "time", "time": time}, "receiver": {"index": receiver}, "effect": effect} for name, time, receiver, effect in timed]
    return scene("Melting ice", "Ice melts into the water that it floats on, whose level stays as it is. A snowman melts too, and in the end the water freezes.", [0.4, 0.92, 0.66], [0, top + 0.03, 0], entities,
                 actions=actions)


def main() -> int:
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "data" / "scenes"
    for make in (card_house, pool_table, domino_spiral, wrecking_ball, newtons_cradle, trampoline, breaking_plates, basin, sheet_metal, awning, beach_balls, melting_ice, torn_paper, wires):
        (folder / f"{make.__name__}.json").write_text(json.dumps(make(), ensure_ascii=False, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
