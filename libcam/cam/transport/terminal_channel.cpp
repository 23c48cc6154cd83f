// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/transport/channels_detail.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>

namespace cam::transport::detail {

namespace {

class TerminalChannel final : public ByteChannel {
  public:
    TerminalChannel(int descriptor, std::string name, LockFile lock)
        : descriptor_(descriptor), name_(std::move(name)), lock_(std::move(lock)) {}

    TerminalChannel(const TerminalChannel&) = delete;
    TerminalChannel& operator=(const TerminalChannel&) = delete;
    TerminalChannel(TerminalChannel&&) = delete;
    TerminalChannel& operator=(TerminalChannel&&) = delete;

    ~TerminalChannel() override {
        unlock_terminal(descriptor_);
        ::close(descriptor_);
    }

    [[nodiscard]] int descriptor() const override { return descriptor_; }

    [[nodiscard]] decomp::Result<std::size_t> read(char* bytes, std::size_t size) override {
        const ssize_t got = ::read(descriptor_, bytes, size);
        if (got > 0) {
            return static_cast<std::size_t>(got);
        }
        if (got < 0 && (errno == EAGAIN || errno == EINTR)) {
            return std::size_t{0};
        }
        // A read of nothing is both "nothing there" and "nobody there any more".
        pollfd watched{descriptor_, POLLIN, 0};
        if (got < 0 || (::poll(&watched, 1, 0) == 1 &&
                        (watched.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0)) {
            return unplugged(name_);
        }
        return std::size_t{0};
    }

    [[nodiscard]] decomp::Result<std::size_t> write(std::string_view bytes) override {
        const ssize_t sent = ::write(descriptor_, bytes.data(), bytes.size());
        if (sent >= 0) {
            return static_cast<std::size_t>(sent);
        }
        if (errno == EAGAIN || errno == EINTR) {
            return std::size_t{0};
        }
        return unplugged(name_);
    }

    void discard_output() override { discard_terminal_output(descriptor_); }

    [[nodiscard]] std::string_view kind() const override { return "terminal"; }

  private:
    int descriptor_;
    std::string name_;
    LockFile lock_;
};

}  // namespace

ChannelResult open_terminal(const std::string& device, const LineSettings& settings,
                            LockFile lock) {
    const int descriptor = ::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) {
        return not_opened(device, errno);
    }
    auto channel = std::make_unique<TerminalChannel>(descriptor, device, std::move(lock));
    if (::isatty(descriptor) == 0) {
        return decomp::fail("transport.bad_name", "this is no serial port and no terminal", device,
                            "'hew ports' lists the ports");
    }
    if (const decomp::Status locked = lock_terminal(descriptor, device); !locked) {
        return decomp::fail(locked.error());
    }
    if (!set_raw(descriptor, settings)) {
        return not_opened(device, errno);
    }
    if (settings.pulse_dtr) {
        pulse_dtr(descriptor);
    }
    return channel;
}

}  // namespace cam::transport::detail
