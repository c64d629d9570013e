#!/usr/bin/env python3
"""bridge_clients.py PROGRAM: public Modbus, RDT, HSES and GigE Vision clients, which know nothing of this project, before
`tubetwin emulate`. Started by bridge_clients.sh, which gets the packages; ARV_TOOL names aravis's tool, or is empty."""

import os
import signal
import struct
import subprocess
import sys
import time
import xml.etree.ElementTree

import NetFT
import pynetft
import pyrobotiqgripper
from pymodbus.client import ModbusSerialClient, ModbusTcpClient
from yrcom.hses_client import HsesClient

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from checks import check, run_tests  # noqa: E402
from emulation import Emulation, Run  # noqa: E402
from motoman import h  # noqa: E402

PROGRAM = sys.argv[1]
ONE_TUBE = ["seed=3", "pile.count=1"]
BOUNDED = ["--for", "2400"]  # Should this test be killed.
ACTION, STATUS, SLAVE = 0x03E8, 0x07D0, 9
TOOL_N = (0.93 + 0.10) * 9.81  # Gripper and coupling hang on the sensor.


class Gripper:
    """The register map of the gripper's manual over a pymodbus client; every byte on the wire is kept."""

    def __init__(self, make):
        self.sent, self.received = b"", b""
        self.client = make(self._trace)
        check(self.client.connect(), "pymodbus connects")

    def _trace(self, sending, data):
        if sending:
            self.sent += data
        else:
            self.received += data
        return data

    def write(self, action, position=0, speed=0, force=0):
        answer = self.client.write_registers(ACTION, [action << 8, position, speed << 8 | force], device_id=SLAVE)
        check(not answer.isError(), f"write: {answer}")

    def read(self, inputs=False):
        """gACT, gGTO, gSTA, gOBJ, gFLT, gPR, gPO."""
        read = self.client.read_input_registers if inputs else self.client.read_holding_registers
        answer = read(STATUS, count=3, device_id=SLAVE)
        if answer.isError():
            check(False, f"read: {answer}")
            return (0,) * 7
        status, fault, position = answer.registers
        bits = status >> 8
        return (bits & 1, bits >> 3 & 1, bits >> 4 & 3, bits >> 6, fault >> 8 & 15, fault & 255, position >> 8)

    def until(self, holds, what, **how):
        for _ in range(600):
            state = self.read(**how)
            if holds(*state):
                return state
            time.sleep(0.02)
        check(False, f"{what}: at last {state}")
        return state


def activate_close_open(gripper):
    """As the manual says it: clear and set rACT, wait for gSTA 3, go to 255, go to 0."""
    gripper.write(0)
    check(gripper.read()[2] == 0, "gSTA is 0 without rACT")
    gripper.write(0x01)
    check(gripper.read()[2] == 1, "gSTA is 1 while it activates")
    gripper.until(lambda act, gto, sta, *_: (act, gto, sta) == (1, 0, 3), "activated")
    gripper.write(0x09, 255, 255, 255)
    seen = gripper.read()
    check(seen[1] == 1 and seen[3] == 0 and seen[5] == 255, f"gGTO, moving, gPR: {seen}")
    closed = gripper.until(lambda *s: s[3] != 0, "closed", inputs=True)
    check(closed[3] == 3 and 226 <= closed[6] <= 232, f"closed on nothing: gOBJ 3, gPO about 230: {closed}")
    gripper.write(0x09, 0x80, 0x80, 0x40)
    between = gripper.until(lambda *s: s[3] != 0, "between")
    check(between[3] == 3 and abs(between[6] - 0x80) <= 2, f"gPO is the request: {between}")
    gripper.write(0x09, 0, 255, 255)
    opened = gripper.until(lambda *s: s[3] != 0, "opened")
    check(opened[3] == 3 and opened[6] <= 6, f"open: gPO about 3: {opened}")
    check(opened[4] == 0, f"no fault: {opened}")
    refused = gripper.client.read_holding_registers(0x0100, count=1, device_id=SLAVE)
    check(refused.isError() and refused.exception_code == 2, f"an address that is none: {refused}")


def modbus_tcp(folder):
    emulation = Emulation(PROGRAM, folder + "/e", overrides=ONE_TUBE, options=BOUNDED)
    port = emulation.devices()["gripper"]["port"]
    gripper = Gripper(lambda trace: ModbusTcpClient("127.0.0.1", port=port, timeout=10, trace_packet=trace))
    activate_close_open(gripper)
    gripper.client.close()
    emulation.stop()


def modbus_rtu(folder):
    """The same over the pseudo-terminal, and the manual's frames are on it, check sums and all."""
    emulation = Emulation(PROGRAM, folder + "/e", overrides=[*ONE_TUBE, "cell.gripper.driver=modbus_rtu"],
                          options=BOUNDED)
    device = emulation.devices()["gripper"]["device"]
    gripper = Gripper(lambda trace: ModbusSerialClient(device, baudrate=115200, timeout=5, trace_packet=trace))
    gripper.client.socket.write(b"\x09\x03garbage before the first frame")
    time.sleep(0.5)
    activate_close_open(gripper)
    gripper.client.close()
    emulation.stop()
    for name, frame in (("clear rACT", "09 10 03E8 0003 06 0000 0000 0000 7330"),
                        ("set rACT", "09 10 03E8 0003 06 0100 0000 0000 72E1"),
                        ("close", "09 10 03E8 0003 06 0900 00FF FFFF 4229"),
                        ("open", "09 10 03E8 0003 06 0900 0000 FFFF 7219"),
                        ("go to 0x80", "09 10 03E8 0003 06 0900 0080 8040 1271"),
                        ("read by 3", "09 03 07D0 0003 040E"), ("read by 4", "09 04 07D0 0003 B1CE")):
        check(h(frame) in gripper.sent, f"RTU: {name} is sent as in the manual")
    check(h("09 10 03E8 0003 0130") in gripper.received, "RTU: a write's answer as in the manual")
    check(h("09 03 06 31 00 00") in gripper.received, "RTU: activation done")


def object_in_the_fingers(folder):
    """A pipeline is killed while it carries a tube: the public client then reads the object, and lets it go."""
    emulation = Emulation(PROGRAM, folder + "/e", rate=2, overrides=ONE_TUBE, options=BOUNDED)
    # Not the watchdogs are tested here: a busy machine may be late.
    patient = [w for device in ("arm", "wrist", "gripper") for w in ("--set", f"cell.safety.{device}_silence_s=4")]
    run = Run(PROGRAM, emulation.cell, folder + "/r", patient)
    while not any(e.get("event") == "carry" for e in emulation.events()) and run.process.poll() is None:
        time.sleep(0.05)
    ended = run.process.poll()
    run.process.send_signal(signal.SIGKILL)
    _, err = run.wait(30)
    check(ended is None, f"a tube is carried; the run has ended with {ended}: {err}")
    port = emulation.devices()["gripper"]["port"]
    gripper = Gripper(lambda trace: ModbusTcpClient("127.0.0.1", port=port, timeout=10, trace_packet=trace))
    held = gripper.until(lambda *s: s[3] == 2, "an object held")
    opening_mm = 85 * (230 - held[6]) / 227
    check(22.5 < opening_mm < 27.5, f"a tube of 25 mm is held at {opening_mm:.1f} mm")
    gripper.write(0x09, 0, 255, 255)
    gripper.until(lambda *s: s[3] == 3 and s[6] <= 6, "let go")
    gripper.client.close()
    emulation.stop()
    check(emulation.world()["held_ids"] == [], "nothing is held by truth")


class Logged:
    """A socket whose datagrams are kept."""

    def __init__(self, link):
        self.link, self.sent, self.received = link, [], []

    def send(self, data):
        self.sent.append(data)
        return self.link.send(data)

    def recv(self, size):
        self.received.append(self.link.recv(size))
        return self.received[-1]


def rdt_netft(folder):
    """PyPI's NetFT: counted records without gaps, the stream, bias by the box."""
    emulation = Emulation(PROGRAM, folder + "/e", overrides=ONE_TUBE, options=BOUNDED)
    wrist = emulation.devices()["wrist"]
    sensor = NetFT.Sensor("127.0.0.1")
    sensor.sock.connect(("127.0.0.1", wrist["port"]))
    sensor.sock.settimeout(20.0)
    sensor.sock = Logged(sensor.sock)
    count = 200
    sensor.getMeasurements(count)
    readings = [sensor.receive() for _ in range(count)]
    records = [struct.unpack("!3I6i", each) for each in sensor.sock.received]
    check([r[0] for r in records] == list(range(1, count + 1)), "RDT: 200 records, no gap")
    check(all(b[1] - a[1] == 7 for a, b in zip(records, records[1:])), "RDT: 7 samples of the box per millisecond")
    check({r[2] for r in records} == {0}, "RDT: a healthy status")
    newtons = sum(r[2] for r in readings) / count / wrist["counts_per_N"]
    check(abs(newtons - TOOL_N) < 0.3, f"NetFT: the tool weighs {newtons:.2f} N")
    check(sensor.sock.sent == [h("1234 0002 000000C8")], "RDT: the documented request")
    sensor.send(0x42)
    biased = [sensor.getMeasurement()[2] / wrist["counts_per_N"] for _ in range(50)]
    check(abs(sum(biased) / 50) < 0.1, f"NetFT: after bias {sum(biased) / 50:.3f} N")
    check(sensor.sock.sent[1] == h("1234 0042 00000000"), "RDT: the documented bias")
    sensor.startStreaming(handler=False)
    for _ in range(50):
        sensor.receive()
    sensor.stopStreaming()
    check(sensor.sock.sent[-1] == h("1234 0000 00000000"), "RDT: the documented stop")
    emulation.stop()


def rdt_pynetft(folder):
    """PyPI's pynetft: counts and units by the box's page, newtons, health of the stream, bias."""
    emulation = Emulation(PROGRAM, folder + "/e", overrides=ONE_TUBE, options=BOUNDED)
    wrist = emulation.devices()["wrist"]
    config = pynetft.Config(sensor_host="127.0.0.1", rdt_port=wrist["port"], http_port=wrist["http_port"],
                            receive_timeout=5.0, configuration_connect_timeout=10.0, configuration_timeout=20.0)
    with pynetft.Client(config, queue_size=4096) as client:
        stream = client.samples(timeout=20.0)
        samples = [next(stream) for _ in range(500)]
        calibration = client.health().sensor_configuration.calibration
        check((calibration.counts_per_force_unit, calibration.counts_per_torque_unit) == (1e6, 1e6), f"{calibration}")
        check(calibration.force_unit == "N" and calibration.torque_unit == "N-m", f"units: {calibration}")
        newtons = sum(s.force[2] for s in samples) / 500
        check(abs(newtons - TOOL_N) < 0.3, f"pynetft: the tool weighs {newtons:.2f} N")
        health = client.health()
        bad = (health.malformed_count, health.duplicate_count, health.out_of_order_count, health.device_error_count,
               health.ft_stall_count, health.ft_backward_count)
        check(bad == (0,) * 6, f"health: {health}")
        client.bias()
        for _ in range(4096):
            sample = next(stream)
        check(abs(sample.force[2]) < 0.2 and abs(sample.torque[0]) < 0.05, f"pynetft: after bias {sample}")
        # Bias starts the stream anew. Records that were under way then make pynetft count the first ones as out of order.
        health = client.health()
        check(health.state == "streaming" and health.fault_code == "none", f"health: {health}")
        bad = (health.malformed_count, health.device_error_count, health.ft_stall_count, health.ft_backward_count)
        check(bad == (0,) * 4, f"health: {health}")
        print(f"pynetft: {health.received_count} records, {health.lost_count} lost", flush=True)
    emulation.stop()


def robotiq_driver(folder):
    """PyPI's pyRobotiqGripper: it activates, moves, and stops fingers on their way."""
    emulation = Emulation(PROGRAM, folder + "/e", overrides=[*ONE_TUBE, "cell.gripper.driver=modbus_rtu"], options=BOUNDED)
    gripper = pyrobotiqgripper.RobotiqGripper(com_port=emulation.devices()["gripper"]["device"],
                                              connection_type=pyrobotiqgripper.GRIPPER_MODE_RTU)
    gripper.connect()
    gripper.activate()
    gripper.start()
    gripper.open()
    check(gripper.status()["gPO"] <= 6, f"pyRobotiqGripper opens: {gripper.status()}")
    gripper.close()
    check(226 <= gripper.status()["gPO"] <= 232, f"pyRobotiqGripper closes: {gripper.status()}")
    gripper.open()
    gripper.close(wait=False, speed=0)
    time.sleep(0.5)
    gripper.stop()
    time.sleep(0.3)
    gripper.readStatus()
    first = gripper.status()["gPO"]
    time.sleep(0.5)
    gripper.readStatus()
    check(0 < first < 200 and gripper.status()["gPO"] == first, f"pyRobotiqGripper stops: {first}, {gripper.status()}")
    gripper.disconnect()
    emulation.stop()


def hses(folder):
    """PyPI's yrcom: status, positions, variables of each kind one by one and several at once, servo, hold, text, job."""
    emulation = Emulation(PROGRAM, folder + "/e", overrides=ONE_TUBE, options=BOUNDED)
    client = HsesClient("127.0.0.1", emulation.devices()["arm"]["hses_port"], timeout=10.0)
    client.open()
    check(client.detect_model() == "yrc1000", "yrcom tells the controller's kind")
    check(client.read_status()["play"] and client.read_alarm_sub()["alarm_code"] == 0, "yrcom: status and alarm")
    check(abs(client.read_position(101)["pos_Rx"]) <= 180.0 and client.load_axis_names()[:6] == tuple("SLURBT"), "yrcom: axes")
    for kind, value in (("register", 3), ("b_var", 7), ("i_var", -5), ("d_var", 70000), ("r_var", 1.5), ("s_var", "hello")):
        getattr(client, "write_" + kind)(5, value)
        check(getattr(client, "read_" + kind)(5) == value, f"yrcom: {kind}")
    for kind, values in (("registers", [1, 2]), ("b_vars", [1, 2]), ("i_vars", [1, -2]), ("d_vars", [1, 2]),
                         ("r_vars", [1.0, 2.0]), ("s_vars", ["a", "b"])):
        getattr(client, "write_" + kind)(6, values)
        check(getattr(client, "read_" + kind)(6, 2) == values, f"yrcom: {kind}")
    client.servo(True)
    client.hold(True)
    check(client.read_status()["hold_cmd"], "yrcom: held")
    client.hold(False)
    client.display_message("hello")
    client.select_job("INIT_ROS")
    for _ in range(200):  # Drives take their time.
        if client.read_status()["servo_on"]:
            break
        time.sleep(0.05)
    client.start_job()
    check(client.read_status()["running"], "yrcom starts the job")
    client.close()
    emulation.stop()


NOBODY = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", "--inh-caps=-all", "--bounding-set=-all"]


def arv_tool(who, *arguments):
    """What aravis's tool prints: its features and their values."""
    run = subprocess.run([*who, os.environ["ARV_TOOL"], *arguments], capture_output=True, text=True, timeout=60)
    check(run.returncode == 0, f"arv-tool {arguments}: {run.returncode} {run.stderr}")
    return run.stdout


def arv_control(who, *settings):
    """{feature: value} of `arv-tool control`, by the address, as Photoneo's examples are called."""
    lines = arv_tool(who, "-a", "127.0.0.1", "control", *settings).splitlines()
    return dict(line.split(" = ", 1) for line in lines if " = " in line)


def aravis(folder):
    """aravis's tool as whoever runs this, and without any right: names, description, components, packets, user sets."""
    emulation = Emulation(PROGRAM, folder + "/e", overrides=ONE_TUBE, options=[*BOUNDED, "--gige"])
    for who in ([], NOBODY) if os.geteuid() == 0 else ([],):
        check("Photoneo-PhoXi3DScan-TWIN-001 (127.0.0.1)" in arv_tool(who), "arv-tool finds the scanner")
        genicam = xml.etree.ElementTree.fromstring(arv_tool(who, "-a", "127.0.0.1", "genicam"))
        named = {node.get("Name") for node in genicam.iter()}
        listed = {feature.text for feature in genicam.iter() if feature.tag.endswith("pFeature")}
        check(listed <= named, f"features of categories without a node: {listed - named}")
        told = arv_control(who, "DeviceVendorName", "DeviceModelName", "SensorWidth", "TLParamsLocked")
        check(told["DeviceVendorName"] == "Photoneo" and told["DeviceModelName"] == "PhoXi3DScan", f"names: {told}")
        pixels = int(told["SensorWidth"].split()[0]) * 772
        for component, number, size in (("Intensity", 1, 2), ("Confidence", 6, 1), ("Normal", 65280, 12)):
            alone = arv_control(who, "ComponentSelector=Range", "ComponentEnable=false",
                                f"ComponentSelector={component}", "ComponentEnable=true", "ComponentIDValue", "PayloadSize",
                                "ComponentEnable=false", "ComponentSelector=Range", "ComponentEnable=true")
            check(int(alone["ComponentIDValue"].split()[0]) == number, f"{component}: {alone}")
            check(int(alone["PayloadSize"].split()[0]) == pixels * size, f"{component}: {alone}")
        size = arv_control(who, "GevSCPSPacketSize=9000", "GevSCPSPacketSize")["GevSCPSPacketSize"]
        check(size.startswith("9000 min:576 max:16000"), f"packet size: {size}")
        saved = arv_control(who, "UserSetSelector=UserSet0", "CameraExposure=40.96", "UserSetSave", "UserSetSelector=Default",
                            "UserSetLoad", "CameraExposure")
        check(saved["CameraExposure"].startswith("20.48"), f"the set as shipped: {saved}")
        loaded = arv_control(who, "UserSetSelector=UserSet0", "UserSetLoad", "CameraExposure")
        check(loaded["CameraExposure"].startswith("40.96"), f"the set that was saved: {loaded}")
        unknown = subprocess.run([*who, os.environ["ARV_TOOL"], "-a", "127.0.0.1", "control", "UserSetSelector=UserSet7"],
                                 capture_output=True, text=True, timeout=60)
        check("UserSet7" in unknown.stdout + unknown.stderr, f"an unknown user set: {unknown}")
        arv_control(who, "UserSetSelector=Default", "UserSetLoad")
    emulation.stop()


TESTS = [modbus_tcp, modbus_rtu, robotiq_driver, object_in_the_fingers, rdt_netft, rdt_pynetft, hses]
run_tests(*TESTS, *([aravis] if os.environ["ARV_TOOL"] else []))
