# SPDX-License-Identifier: GPL-3.0-or-later
"""A PLC with the G-code mailbox, written from docs/modbus-mailbox.md alone, on pymodbus.

mailbox_plc.py PORT EXECUTED: serves 127.0.0.1:PORT, unit 1, and keeps the lines that it carried out in a file.
"""

import re
import sys
import threading
import time
import zlib

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server import StartTcpServer

SLOTS, SLOT_REGS, QUEUE = 3, 60, 40
INIT, IDLE, RUN, HOLD, ALARM, ESTOP, TOOL, DONE = range(8)


class Plc:
    def __init__(self, executed):
        self.block = ModbusSequentialDataBlock(0, [0] * 1000)
        self.r = self.block.values
        self.executed = open(executed, "w", buffering=1)
        self.state, self.error, self.nonce = IDLE, 0, 0
        self.job = self.acc = self.exec = self.total = 0
        self.heard, self.heard_tag, self.echo = [0] * SLOTS, 0, 0
        self.seen = [0] * SLOTS
        self.queue, self.position, self.relative = [], [0.0] * 6, False
        self.watchdog, self.alive_at = 1.0, time.monotonic()
        self.doubled = 0
        self.publish()

    def two(self, address):
        return self.r[address] << 16 | self.r[address + 1]

    def put(self, address, value):
        self.r[address], self.r[address + 1] = value >> 16 & 0xFFFF, value & 0xFFFF

    def publish(self):
        self.r[0:6] = [0x4742, 1, SLOTS, SLOT_REGS, 1, 2 | 4]
        self.put(6, 77)
        self.r[16:19] = [self.state, self.error, self.nonce]
        for address, value in ((19, self.job), (21, self.acc), (23, self.exec)):
            self.put(address, value)
        self.r[27], self.r[29] = QUEUE - len(self.queue), self.doubled
        for axis in range(6):
            self.put(30 + 2 * axis, round(self.position[axis] * 1000) & 0xFFFFFFFF)
        self.r[45], self.r[46], self.r[47] = 100, 1 << 2, self.echo

    def scan(self):
        self.tags()
        if self.state == RUN and time.monotonic() - self.alive_at > self.watchdog:
            self.state, self.error = HOLD, 6
        if self.r[50] != self.nonce:
            self.command(self.r[49])
            self.nonce = self.r[50]
        again = self.state in (RUN, HOLD)
        while again:
            again = self.slots()
        if self.state == RUN:
            self.motion()
        self.publish()

    def tags(self):
        alive = False
        if self.r[48] != self.heard_tag:
            self.heard_tag = self.echo = self.r[48]
            alive = True
        for k in range(SLOTS):
            tag = self.r[64 + k * SLOT_REGS]
            if tag != self.heard[k]:
                self.heard[k] = tag
                alive = True
                if 0 < (tag - self.echo & 0xFFFF) < 0x8000:
                    self.echo = tag
        if alive:
            self.alive_at = time.monotonic()

    def command(self, command):
        if command == 1 and self.state in (IDLE, DONE):
            self.job, self.total = self.two(51), self.two(55)
            self.acc = self.exec = self.two(53) - 1
            self.watchdog = self.r[59] / 1000
            self.queue, self.error, self.state = [], 0, RUN
            self.seen = [self.r[64 + k * SLOT_REGS] for k in range(SLOTS)]
        elif command == 2 and self.state == RUN:
            self.state = HOLD
        elif command == 3 and self.state == HOLD:
            self.state, self.error = RUN, 0
        elif command == 5:
            self.queue, self.job, self.state, self.error = [], 0, IDLE, 0
        elif command == 6 and self.state == ALARM:
            self.state, self.error, self.job = IDLE, 0, 0

    def slots(self):
        again, waits, gap = False, False, False
        for k in range(SLOTS):
            base = 64 + k * SLOT_REGS
            tag, low_job = self.r[base], self.r[base + 1]
            if tag == self.seen[k]:
                continue
            first, kind, length = self.two(base + 2), self.r[base + 4], self.r[base + 5]
            count = kind & 0xFF
            text = b"".join(v.to_bytes(2, "big") for v in self.r[base + 8 : base + 8 + (length + 1) // 2])[:length]
            head = b"".join(v.to_bytes(2, "big") for v in (low_job, first >> 16, first & 0xFFFF, kind, length))
            if kind >> 8 != 1 or low_job != self.job & 0xFFFF or zlib.crc32(head + text) != self.two(base + 6):
                self.error = 3
            elif first + count - 1 <= self.acc:
                self.doubled += 1
                self.seen[k] = tag
                again = True
            elif first != self.acc + 1:
                gap = True
            elif len(self.queue) + count > QUEUE:
                waits = True
            else:
                self.queue += text.decode("ascii").split("\n")[:count]
                self.acc += count
                self.seen[k] = tag
                again = True
                if self.error in (2, 3):
                    self.error = 0
        if gap and not waits and self.error == 0:
            self.error = 2
        return again

    def motion(self):
        for line in self.queue[:12]:
            words = re.findall(r"([A-Z])([-+0-9.]+)", line)
            self.relative = (self.relative or ("G", "91") in words) and ("G", "90") not in words
            for letter, number in words:
                if letter in "XYZABC":
                    axis = "XYZABC".index(letter)
                    self.position[axis] = float(number) + (self.position[axis] if self.relative else 0)
            self.executed.write(line + "\n")
            self.exec += 1
        del self.queue[:12]
        if self.exec == self.total:
            self.state = DONE


def main():
    plc = Plc(sys.argv[2])

    def scans():
        while True:
            plc.scan()
            time.sleep(0.003)

    threading.Thread(target=scans, daemon=True).start()
    slave = ModbusSlaveContext(hr=plc.block, zero_mode=True)
    StartTcpServer(context=ModbusServerContext(slaves=slave, single=True), address=("127.0.0.1", int(sys.argv[1])))


main()
