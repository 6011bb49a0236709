# SPDX-License-Identifier: MIT
"""Databases that are damaged in many ways: bytes, pages, ends, the schema, values in the columns."""
import pathlib
import random
import shutil
import sqlite3

PAGE = 4096
STATEMENTS = [
    "DROP TABLE model_words", "DROP TABLE model_knowledge", "DROP TABLE manual_change", "DROP TABLE setting", "DROP TABLE stored_geometry", "DROP TABLE model_simulation_mesh",
    "ALTER TABLE model RENAME TO model2", "ALTER TABLE model DROP COLUMN quality", "CREATE TRIGGER evil AFTER UPDATE ON model BEGIN DELETE FROM model; END",
    "PRAGMA user_version = 0", "PRAGMA user_version = 1", "PRAGMA user_version = 99", "PRAGMA user_version = -1", "PRAGMA application_id = 0", "PRAGMA application_id = 7",
    "UPDATE model_knowledge SET facts = 'x'", "UPDATE model_knowledge SET facts = '{\"name\": ' || char(34) || char(55296) || char(34) || '}'",
    "UPDATE model_knowledge SET attributes = '[1e999]'", "UPDATE model_knowledge SET attributes = '{}'",
    "UPDATE model_knowledge SET attributes = replace(hex(zeroblob(500000)), '00', '[')", "UPDATE model_knowledge SET facts = replace(hex(zeroblob(500000)), '00', '{\"a\":')",
    "UPDATE stored_geometry SET compact = zeroblob(100000000)", "UPDATE stored_geometry SET compact = substr(compact, 1, 100)", "UPDATE stored_geometry SET hull_points = zeroblob(7)",
    "UPDATE stored_geometry SET hull_points = randomblob(1200)", "UPDATE stored_geometry SET compact = randomblob(3000)", "UPDATE stored_picture SET png = randomblob(500)",
    "UPDATE model SET name = char(27) || '[2J' || char(8238) || char(10)", "UPDATE model SET name = replace(hex(zeroblob(1000000)), '00', 'x')", "UPDATE model SET tags = char(0)",
    "UPDATE model SET quality = 99", "UPDATE model SET name = CAST(x'ff00fe' AS TEXT)", "UPDATE model SET category = CAST(x'ff' AS TEXT)", "DELETE FROM model_geometry",
    "DELETE FROM setting", "UPDATE setting SET value = CAST(x'ff' AS TEXT)", "UPDATE setting SET value = '99999999999999999999'", "DELETE FROM model",
    "INSERT INTO manual_attribute SELECT key, 'mass', '\"heavy\"', 'x', 'y' FROM model", "UPDATE model_geometry SET geometry = 424242",
    "INSERT INTO model_words (model_words) VALUES ('delete-all')"]


def run_sql(database: pathlib.Path, statement: str):
    connection = sqlite3.connect(database)
    connection.text_factory = bytes
    try:
        connection.execute("PRAGMA foreign_keys = OFF")
        connection.execute("PRAGMA ignore_check_constraints = ON")
        connection.execute(statement)
        connection.commit()
    except sqlite3.Error:
        connection.rollback()  # a statement that this schema refuses changes nothing
    finally:
        connection.close()


def damage(chance: random.Random, database: pathlib.Path, number: int):
    """Damages a copy; each `number` below the count of statements runs one of them, higher ones damage at random."""
    if number < len(STATEMENTS):
        return run_sql(database, STATEMENTS[number])
    data = bytearray(database.read_bytes())
    way = chance.randrange(8)
    if way == 0:
        del data[chance.randrange(len(data)):]
    elif way == 1:  # a page of zeros or of random bytes
        at = PAGE * chance.randrange(len(data) // PAGE)
        data[at:at + PAGE] = chance.choice([bytes(PAGE), chance.randbytes(PAGE)])
    elif way == 2:  # two pages exchanged
        a, b = (PAGE * chance.randrange(len(data) // PAGE) for _ in range(2))
        data[a:a + PAGE], data[b:b + PAGE] = data[b:b + PAGE], data[a:a + PAGE]
    elif way == 3:  # the file header
        at = chance.randrange(100)
        data[at] ^= 1 << chance.randrange(8)
    elif way == 4:  # many bits
        for _ in range(chance.choice([1, 20, 500])):
            data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
    elif way == 5:  # the schema's own text
        at = bytes(data).find(b"CREATE TABLE", chance.randrange(PAGE * 2))
        if at >= 0:
            data[at + 13:at + 17] = b"xxxx"
    elif way == 6:
        data += bytes(chance.choice([1, PAGE, 10 * PAGE]))
    else:  # an unrelated write-ahead log beside the file
        database.with_name(database.name + chance.choice(["-wal", "-journal"])).write_bytes(chance.randbytes(chance.choice([0, 32, 5000])))
    database.write_bytes(data)


def copy_of(good: pathlib.Path, folder: pathlib.Path) -> pathlib.Path:
    folder.mkdir()
    return pathlib.Path(shutil.copy(good, folder / "models.sqlite"))
