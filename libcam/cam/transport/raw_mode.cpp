// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel's own structures: those of the C library know no speed such as 250000.
#include "cam/transport/channels_detail.h"

#include <asm/termbits.h>
#include <sys/ioctl.h>

#include <chrono>
#include <thread>

namespace cam::transport::detail {

bool set_raw(int descriptor, const LineSettings& settings) {
    termios2 modes{};
    if (::ioctl(descriptor, TCGETS2, &modes) != 0) {
        return false;
    }
    modes.c_iflag = 0;
    modes.c_oflag = 0;
    modes.c_lflag = 0;
    modes.c_cflag = CS8 | CREAD | CLOCAL | BOTHER;
    if (settings.rts_cts) {
        modes.c_cflag |= CRTSCTS;
    }
    if (settings.reset_on_close) {
        modes.c_cflag |= HUPCL;
    }
    modes.c_ispeed = static_cast<speed_t>(settings.baud);
    modes.c_ospeed = static_cast<speed_t>(settings.baud);
    modes.c_cc[VMIN] = 0;
    modes.c_cc[VTIME] = 0;
    // What was said to an earlier program is no answer to this one.
    ::ioctl(descriptor, TCFLSH, TCIFLUSH);
    return ::ioctl(descriptor, TCSETS2, &modes) == 0;
}

void set_hang_up(int descriptor, bool hang_up) {
    termios2 modes{};
    if (::ioctl(descriptor, TCGETS2, &modes) == 0) {
        modes.c_cflag = hang_up ? modes.c_cflag | HUPCL : modes.c_cflag & ~HUPCL;
        ::ioctl(descriptor, TCSETS2, &modes);
    }
}

void pulse_dtr(int descriptor) {
    int dtr = TIOCM_DTR;
    if (::ioctl(descriptor, TIOCMBIC, &dtr) == 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        ::ioctl(descriptor, TIOCMBIS, &dtr);
    }
}

void discard_terminal_output(int descriptor) { ::ioctl(descriptor, TCFLSH, TCOFLUSH); }

}  // namespace cam::transport::detail
