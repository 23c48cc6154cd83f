// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/transport/channels_detail.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

namespace cam::transport::detail {

namespace {

constexpr int kConnectMilliseconds = 5000;

class TcpChannel final : public ByteChannel {
  public:
    TcpChannel(int descriptor, std::string name)
        : descriptor_(descriptor), name_(std::move(name)) {}

    TcpChannel(const TcpChannel&) = delete;
    TcpChannel& operator=(const TcpChannel&) = delete;
    TcpChannel(TcpChannel&&) = delete;
    TcpChannel& operator=(TcpChannel&&) = delete;

    ~TcpChannel() override { ::close(descriptor_); }

    [[nodiscard]] int descriptor() const override { return descriptor_; }

    [[nodiscard]] decomp::Result<std::size_t> read(char* bytes, std::size_t size) override {
        const ssize_t got = ::recv(descriptor_, bytes, size, 0);
        if (got > 0) {
            return static_cast<std::size_t>(got);
        }
        if (got < 0 && (errno == EAGAIN || errno == EINTR)) {
            return std::size_t{0};
        }
        return unplugged(name_);
    }

    [[nodiscard]] decomp::Result<std::size_t> write(std::string_view bytes) override {
        const ssize_t sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent >= 0) {
            return static_cast<std::size_t>(sent);
        }
        if (errno == EAGAIN || errno == EINTR) {
            return std::size_t{0};
        }
        return unplugged(name_);
    }

    /// What TCP has taken cannot be called back.
    void discard_output() override {}

    [[nodiscard]] std::string_view kind() const override { return "TCP"; }

  private:
    int descriptor_;
    std::string name_;
};

/// Connects within a bounded time; -1 with errno otherwise.
int connected(const addrinfo& address) {
    const int descriptor =
        ::socket(address.ai_family, address.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (descriptor < 0) {
        return -1;
    }
    int error = 0;
    if (::connect(descriptor, address.ai_addr, address.ai_addrlen) != 0) {
        error = errno;
        pollfd watched{descriptor, POLLOUT, 0};
        if (error == EINPROGRESS) {
            socklen_t size = sizeof error;
            error = ETIMEDOUT;
            if (::poll(&watched, 1, kConnectMilliseconds) == 1) {
                ::getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &error, &size);
            }
        }
    }
    if (error != 0) {
        ::close(descriptor);
        errno = error;
        return -1;
    }
    const int on = 1;
    ::setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    return descriptor;
}

}  // namespace

ChannelResult open_tcp(const std::string& address) {
    const std::size_t colon = address.rfind(':');
    if (colon == std::string::npos || colon == 0 || colon + 1 == address.size()) {
        return decomp::fail("transport.bad_name", "a network port is tcp:HOST:PORT", address,
                            "tcp:192.0.2.7:23");
    }
    addrinfo wanted{};
    wanted.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const int error = ::getaddrinfo(address.substr(0, colon).c_str(),
                                    address.substr(colon + 1).c_str(), &wanted, &found);
    if (error != 0) {
        return decomp::fail("transport.not_found", ::gai_strerror(error), address);
    }
    int descriptor = -1;
    for (const addrinfo* one = found; one != nullptr && descriptor < 0; one = one->ai_next) {
        descriptor = connected(*one);
    }
    const int error_number = errno;
    ::freeaddrinfo(found);
    if (descriptor < 0) {
        return not_opened("tcp:" + address, error_number);
    }
    return std::make_unique<TcpChannel>(descriptor, "tcp:" + address);
}

}  // namespace cam::transport::detail
