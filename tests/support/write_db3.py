"""Writes a database as rosbag2's of ROS 2 Humble: write_db3.py LINES FILE [wal]; each line of LINES has a topic, a
type, a time [ns] and the bytes of a message in hex."""
import sqlite3
import sys

lines = [line.split() for line in open(sys.argv[1], encoding="utf-8")]
db = sqlite3.connect(sys.argv[2])
if "wal" in sys.argv[3:]:
    db.execute("PRAGMA journal_mode = WAL")
db.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
           "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
db.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
db.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
topics = {}
for topic, kind, time, data in lines:
    if topic not in topics:
        topics[topic] = len(topics) + 1
        db.execute("INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')", (topics[topic], topic, kind))
    db.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", (topics[topic], int(time), bytes.fromhex(data)))
db.commit()
db.close()
