// SPDX-License-Identifier: GPL-3.0-or-later
// libserialport 0.1.1: it refuses symbolic links and ports without modem lines, sets HUPCL when it
// opens, reports a full buffer as a failure with EAGAIN, and a pulled cable as a read of nothing.
#include "cam/transport/channels_detail.h"

#include <fcntl.h>
#include <libserialport.h>

#include <cerrno>

namespace cam::transport::detail {

namespace {

class SerialChannel final : public ByteChannel {
  public:
    SerialChannel(sp_port* port, int descriptor, std::string name, LockFile lock)
        : port_(port), descriptor_(descriptor), name_(std::move(name)), lock_(std::move(lock)) {}

    SerialChannel(const SerialChannel&) = delete;
    SerialChannel& operator=(const SerialChannel&) = delete;
    SerialChannel(SerialChannel&&) = delete;
    SerialChannel& operator=(SerialChannel&&) = delete;

    ~SerialChannel() override {
        unlock_terminal(descriptor_);
        ::sp_close(port_);
        ::sp_free_port(port_);
    }

    [[nodiscard]] int descriptor() const override { return descriptor_; }

    [[nodiscard]] decomp::Result<std::size_t> read(char* bytes, std::size_t size) override {
        const int got = ::sp_nonblocking_read(port_, bytes, size);
        if (got > 0) {
            return static_cast<std::size_t>(got);
        }
        if ((got < 0 && errno != EAGAIN && errno != EINTR) || ::sp_input_waiting(port_) < 0) {
            return unplugged(name_);
        }
        return std::size_t{0};
    }

    [[nodiscard]] decomp::Result<std::size_t> write(std::string_view bytes) override {
        const int sent = ::sp_nonblocking_write(port_, bytes.data(), bytes.size());
        if (sent >= 0) {
            return static_cast<std::size_t>(sent);
        }
        if (errno == EAGAIN || errno == EINTR) {
            return std::size_t{0};
        }
        return unplugged(name_);
    }

    void discard_output() override { ::sp_flush(port_, SP_BUF_OUTPUT); }

    [[nodiscard]] std::string_view kind() const override { return "libserialport"; }

  private:
    sp_port* port_;
    int descriptor_;
    std::string name_;
    LockFile lock_;
};

bool configure(sp_port* port, const LineSettings& settings) {
    return ::sp_set_baudrate(port, settings.baud) == SP_OK && ::sp_set_bits(port, 8) == SP_OK &&
           ::sp_set_parity(port, SP_PARITY_NONE) == SP_OK && ::sp_set_stopbits(port, 1) == SP_OK &&
           ::sp_set_flowcontrol(
               port, settings.rts_cts ? SP_FLOWCONTROL_RTSCTS : SP_FLOWCONTROL_NONE) == SP_OK;
}

}  // namespace

std::optional<ChannelResult> open_serial(const std::string& device, const LineSettings& settings,
                                         LockFile& lock) {
    sp_port* port = nullptr;
    if (::sp_get_port_by_name(device.c_str(), &port) != SP_OK) {
        return std::nullopt;
    }
    if (::sp_open(port, SP_MODE_READ_WRITE) != SP_OK) {
        const int error_number = ::sp_last_error_code();
        ::sp_free_port(port);
        if (error_number == ENOTTY) {
            return std::nullopt;
        }
        return not_opened(device, error_number);
    }
    int descriptor = -1;
    ::sp_get_port_handle(port, &descriptor);
    auto channel = std::make_unique<SerialChannel>(port, descriptor, device, std::move(lock));
    ::fcntl(descriptor, F_SETFD, FD_CLOEXEC);
    if (const decomp::Status locked = lock_terminal(descriptor, device); !locked) {
        return decomp::fail(locked.error());
    }
    if (!configure(port, settings)) {
        return not_opened(device, ::sp_last_error_code());
    }
    // What was said to an earlier program is no answer to this one.
    ::sp_flush(port, SP_BUF_INPUT);
    set_hang_up(descriptor, settings.reset_on_close);
    if (settings.pulse_dtr) {
        pulse_dtr(descriptor);
    }
    return channel;
}

}  // namespace cam::transport::detail
