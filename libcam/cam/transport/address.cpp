// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/transport/modbus.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstring>

namespace cam::transport {

namespace {

bool is_public(const sockaddr_in& address) {
    const std::uint32_t ip = ntohl(address.sin_addr.s_addr);
    const auto within = [&](std::uint32_t net, unsigned bits) {
        return ip >> (32U - bits) == net >> (32U - bits);
    };
    return !(within(0x7F000000, 8) || within(0x0A000000, 8) || within(0xAC100000, 12) ||
             within(0xC0A80000, 16) || within(0xA9FE0000, 16));
}

bool is_public(const sockaddr_in6& address) {
    const in6_addr& ip = address.sin6_addr;
    if (IN6_IS_ADDR_V4MAPPED(&ip)) {
        sockaddr_in inner{};
        std::memcpy(&inner.sin_addr, &ip.s6_addr[12], 4);
        return is_public(inner);
    }
    return !(IN6_IS_ADDR_LOOPBACK(&ip) || IN6_IS_ADDR_LINKLOCAL(&ip) ||
             (ip.s6_addr[0] & 0xFEU) == 0xFCU);
}

}  // namespace

bool is_public_address(const std::string& port) {
    constexpr std::size_t kTcp = 4;
    const std::size_t colon = port.rfind(':');
    if (!port.starts_with("tcp:") || colon == std::string::npos) {
        return false;
    }
    const std::string host = colon < kTcp ? port.substr(kTcp) : port.substr(kTcp, colon - kTcp);
    addrinfo wanted{};
    wanted.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (::getaddrinfo(host.c_str(), nullptr, &wanted, &found) != 0) {
        return false;
    }
    bool outside = false;
    for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
        if (one->ai_family == AF_INET) {
            sockaddr_in address{};
            std::memcpy(&address, one->ai_addr, sizeof address);
            outside = outside || is_public(address);
        } else if (one->ai_family == AF_INET6) {
            sockaddr_in6 address{};
            std::memcpy(&address, one->ai_addr, sizeof address);
            outside = outside || is_public(address);
        }
    }
    ::freeaddrinfo(found);
    return outside;
}

}  // namespace cam::transport
