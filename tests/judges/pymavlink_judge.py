"""Flies the craft at a MAVLink door with pymavlink: `pymavlink_judge.py ADDRESS`. Ends with 0 if everything was as expected."""

import math
import os
import sys
import time

os.environ["MAVLINK20"] = "1"

from pymavlink import mavutil

PATIENCE_S = 120
NAN = math.nan


class Station:
    def __init__(self, address):
        began = time.monotonic()
        self.link = mavutil.mavlink_connection(f"tcp:{address}", source_system=255)
        self.texts = []
        assert self.link.wait_heartbeat(timeout=PATIENCE_S), "no heartbeat"
        print(f"connected in {time.monotonic() - began:.2f} s")
        self.mav = self.link.mav

    def wait(self, what, kinds, is_wanted=lambda message: True):
        """Returns the first message of these kinds that is wanted."""
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            message = self.link.recv_match(blocking=True, timeout=1)
            if message is None:
                continue
            if message.get_type() == "STATUSTEXT":
                self.texts.append(message.text)
            if message.get_type() in kinds and is_wanted(message):
                return message
        raise AssertionError(f"no {what}: {self.texts}")

    def command(self, command, *params):
        params = list(params) + [0] * (7 - len(params))
        self.mav.command_long_send(1, 1, command, 0, *params)
        return self.wait(f"answer to {command}", ["COMMAND_ACK"], lambda ack: ack.command == command).result

    def until_accepted(self, command, *params):
        """Sends a command until the craft accepts it."""
        for _ in range(PATIENCE_S):
            if self.command(command, *params) == 0:
                return
            time.sleep(0.5)
        raise AssertionError(f"command {command} was not accepted: {self.texts}")

    def parameters(self):
        self.mav.param_request_list_send(1, 1)
        values = {}
        while True:
            value = self.wait("parameter", ["PARAM_VALUE"])
            values[value.param_index] = (value.param_id, value.param_value)
            if len(values) == value.param_count:
                return dict(values.values())

    def upload(self, items):
        self.mav.mission_count_send(1, 1, len(items), 0)
        while True:
            kinds = ["MISSION_REQUEST_INT", "MISSION_REQUEST", "MISSION_ACK"]
            message = self.wait("mission request", kinds)
            if message.get_type() == "MISSION_ACK":
                assert message.type == 0, message
                return
            self.mav.send(items[message.seq])

    def download(self):
        self.mav.mission_request_list_send(1, 1, 0)
        count = self.wait("mission count", ["MISSION_COUNT"]).count
        items = []
        for number in range(count):
            self.mav.mission_request_int_send(1, 1, number, 0)
            items.append(self.wait("item", ["MISSION_ITEM_INT"], lambda item: item.seq == number))
        self.mav.mission_ack_send(1, 1, 0, 0)
        return items

    def is_armed(self, armed):
        self.wait(f"armed {armed}", ["HEARTBEAT"], lambda beat: bool(beat.base_mode & 128) == armed)

    def climbs_to(self, altitude_m):
        self.wait("altitude", ["GLOBAL_POSITION_INT"], lambda at: at.relative_alt > 1000 * altitude_m)


def main(address):
    station = Station(address)
    fix = station.wait("fix", ["GPS_RAW_INT"], lambda gps: gps.fix_type >= 3 and gps.satellites_visible > 5)
    lat, lon = fix.lat, fix.lon

    parameters = station.parameters()
    assert len(parameters) > 50 and parameters["AP_MAX_ANGLE"] > 0, parameters
    for number, kept in [(33, 33), (999, 33)]:
        station.mav.param_set_send(1, 1, b"AP_MAX_ANGLE", number, 9)
        is_it = lambda value: value.param_id == "AP_MAX_ANGLE" and value.param_value == kept
        station.wait("parameter", ["PARAM_VALUE"], is_it)

    def item(number, command, north, east, alt):
        place = (lat + north, lon + east, alt)
        send = station.mav.mission_item_int_encode
        return send(1, 1, number, 3, command, 0, 1, 0, 0, 0, NAN, *place, 0)

    # ArduPilot's mission begins with home.
    beat = station.link.messages["HEARTBEAT"]
    places = [(16, 4000, 0, 12), (16, 4000, 5000, 12), (21, 0, 5000, 0)]
    places = ([(16, 0, 0, 0)] if beat.autopilot == 3 else []) + places
    station.upload([item(number, *place) for number, place in enumerate(places)])
    back = [(at.command, at.x, at.y) for at in station.download()]
    sent = [(command, lat + north, lon + east) for command, north, east, _ in places]
    first = 1 if beat.autopilot == 3 else 0
    assert back[first:] == sent[first:], (back, sent)
    # Long texts come in parts.
    assert "altitude of a MAVLink LAND" in "".join(station.texts), station.texts

    station.until_accepted(400, 1)
    assert station.command(22, 0, 0, 0, 0, 0, 0, 8) == 0
    station.climbs_to(7)
    assert station.command(400, 0) != 0, "a craft in the air was disarmed"
    assert station.command(300) == 0
    station.wait("first item reached", ["MISSION_ITEM_REACHED"])
    assert station.command(193, 0) == 0
    station.wait("pause", ["MISSION_CURRENT"], lambda current: current.mission_state != 3)
    assert station.command(193, 1) == 0
    station.wait("second item reached", ["MISSION_ITEM_REACHED"])
    assert station.command(20) == 0
    station.is_armed(False)
    station.until_accepted(400, 1)
    assert station.command(22, 0, 0, 0, 0, 0, 0, 5) == 0
    station.climbs_to(4)
    assert station.command(21) == 0
    station.is_armed(False)
    print("pymavlink: as expected")


main(sys.argv[1])
