"""Flies the craft at a MAVLink door with MAVSDK: `mavsdk_judge.py ADDRESS`. Ends with 0 if everything was as expected."""

import sys
import time

from mavsdk.component_type import ComponentType
from mavsdk.mavsdk import Configuration, Mavsdk
from mavsdk.plugins.action import Action
from mavsdk.plugins.action.action import ActionError
from mavsdk.plugins.mission_raw import MissionItem, MissionRaw
from mavsdk.plugins.telemetry import Telemetry

PATIENCE_S = 120


def wait(what, is_so):
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        if is_so():
            return
        time.sleep(0.1)
    raise AssertionError(f"never: {what}")


def until_done(what, act):
    """Repeats an action until the craft accepts it."""
    end = time.monotonic() + PATIENCE_S
    while True:
        try:
            return act()
        except Exception as refused:
            if time.monotonic() > end:
                raise AssertionError(f"{what}: {refused}") from refused
            time.sleep(0.5)


def main(address):
    began = time.monotonic()
    station = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    station.add_any_connection(f"tcpout://{address}")
    system = station.first_autopilot(30.0)
    assert system, "no craft"
    print(f"connected in {time.monotonic() - began:.2f} s")
    action, missions, telemetry = Action(system), MissionRaw(system), Telemetry(system)
    texts = []
    telemetry.subscribe_status_text(lambda text, *_: texts.append(str(text)))
    wait("a fix", lambda: telemetry.gps_info().num_satellites > 5 and abs(telemetry.position().latitude_deg) > 1)
    place = telemetry.position()
    lat, lon = round(place.latitude_deg * 1e7), round(place.longitude_deg * 1e7)

    def item(number, command, north, east, alt):
        kinds = dict(seq=number, frame=3, command=command, current=int(number == 0), autocontinue=1)
        params = dict(param1=0, param2=0, param3=0, param4=float("nan"))
        return MissionItem(**kinds, **params, x=lat + north, y=lon + east, z=alt, mission_type=0)

    sent = [item(0, 16, 4000, 0, 12), item(1, 16, 4000, 5000, 12), item(2, 21, 0, 5000, 0)]
    until_done("upload", lambda: missions.upload_mission(sent))
    back = missions.download_mission()
    back = back.mission_items if hasattr(back, "mission_items") else back
    places = lambda items: [(at.command, at.x, at.y) for at in items]
    # ArduPilot's mission begins with home, for which MAVSDK has no place of its own.
    assert places(back)[-len(sent) + 1 :] == places(sent)[1:], (places(back), places(sent))
    wait("the loss report", lambda: any("LAND is that of the ground" in text for text in texts))

    until_done("arming", action.arm)
    try:
        action.set_takeoff_altitude(10.0)
    except ActionError:
        # A parameter of PX4, which the craft does not have. Without it the craft climbs to 10 m.
        pass
    action.takeoff()
    wait("8 m", lambda: telemetry.position().relative_altitude_m > 7)
    until_done("start", missions.start_mission)
    wait("the second item", lambda: missions.mission_progress().current >= 1)
    missions.pause_mission()
    until_done("continue", missions.start_mission)
    action.return_to_launch()
    wait("disarmed at home", lambda: not telemetry.armed())
    until_done("arming", action.arm)
    action.takeoff()
    wait("5 m", lambda: telemetry.position().relative_altitude_m > 5)
    action.land()
    wait("disarmed after the landing", lambda: not telemetry.armed())
    print("MAVSDK: as expected")


main(sys.argv[1])
