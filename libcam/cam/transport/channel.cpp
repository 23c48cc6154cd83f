// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/transport/channel.h"

#include "cam/transport/channels_detail.h"

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace cam::transport {

namespace detail {

tl::unexpected<decomp::Error> unplugged(const std::string& name) {
    return decomp::fail("transport.unplugged", "the port is gone: unplugged, or switched off", name,
                        "plug it in again; the job waits");
}

tl::unexpected<decomp::Error> not_opened(const std::string& name, int error_number) {
    if (error_number == ENOENT || error_number == ENXIO || error_number == ENODEV) {
        return decomp::fail("transport.not_found", "there is no such port", name,
                            "'hew ports' lists the ports");
    }
    if (error_number == EACCES || error_number == EPERM) {
        return decomp::fail("transport.no_permission", "this user may not open the port", name,
                            "be a member of the group 'dialout' (sudo adduser $USER dialout), then "
                            "log in again");
    }
    if (error_number == EBUSY) {
        return decomp::fail("transport.busy", "another program has taken the port", name,
                            "end that program first");
    }
    return decomp::fail("transport.refused",
                        std::string("the port cannot be used: ") + std::strerror(error_number),
                        name);
}

}  // namespace detail

decomp::Result<std::unique_ptr<ByteChannel>> open_channel(const std::string& port,
                                                          const LineSettings& settings) {
    constexpr std::string_view kTcp = "tcp:";
    if (port.starts_with(kTcp)) {
        return detail::open_tcp(port.substr(kTcp.size()));
    }
    std::error_code error;
    // By-id names are links, which libserialport refuses.
    const std::filesystem::path device = std::filesystem::canonical(port, error);
    if (error) {
        return detail::not_opened(port, error.value());
    }
    auto lock = LockFile::take(device);
    if (!lock) {
        return decomp::fail(lock.error());
    }
    if (auto opened = detail::open_serial(device.string(), settings, *lock)) {
        return std::move(*opened);
    }
    return detail::open_terminal(device.string(), settings, std::move(*lock));
}

}  // namespace cam::transport
