// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/modbus_server.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <pty.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <sstream>
#include <utility>

namespace cam::sim {

using namespace std::chrono_literals;

namespace {

constexpr std::size_t kMostBytes = 4096;

Time time_now() { return std::chrono::steady_clock::now().time_since_epoch(); }

unsigned at(const std::string& bytes, std::size_t index) {
    return static_cast<unsigned char>(bytes[index]);
}

unsigned word(const std::string& bytes, std::size_t index) {
    return at(bytes, index) << 8U | at(bytes, index + 1);
}

void add(std::string& bytes, unsigned value) {
    bytes += static_cast<char>(value >> 8U & 0xFFU);
    bytes += static_cast<char>(value & 0xFFU);
}

/// The frame's own sum, low byte first on the wire.
std::uint16_t crc16(std::string_view bytes) {
    unsigned crc = 0xFFFF;
    for (const char c : bytes) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc & 1U) != 0 ? crc >> 1U ^ 0xA001U : crc >> 1U;
        }
    }
    return static_cast<std::uint16_t>(crc);
}

/// Bytes of the RTU request that begins here; 0: not known yet. Functions that are not spoken have
/// the length of the most common ones.
std::size_t rtu_length(const std::string& in) {
    if (in.size() < 2) {
        return 0;
    }
    const std::size_t count_at = at(in, 1) == 23 ? 10 : at(in, 1) == 16 || at(in, 1) == 15 ? 6 : 0;
    if (count_at == 0) {
        return 8;
    }
    return in.size() > count_at ? count_at + 1 + at(in, count_at) + 2 : 0;
}

std::string exception(unsigned function, int code) {
    return {static_cast<char>(function | 0x80U), static_cast<char>(code)};
}

bool read_values(const std::string& pdu, std::size_t count_at, std::vector<std::uint16_t>& values) {
    if (pdu.size() <= count_at || pdu.size() != count_at + 1 + at(pdu, count_at) ||
        2 * word(pdu, count_at - 2) != at(pdu, count_at)) {
        return false;
    }
    for (std::size_t i = count_at + 1; i + 1 < pdu.size(); i += 2) {
        values.push_back(static_cast<std::uint16_t>(word(pdu, i)));
    }
    return true;
}

bool read_number(const std::string& text, double& value, std::string& unit) {
    char* end = nullptr;
    value = std::strtod(text.c_str(), &end);
    unit = end;
    return end != text.c_str() && value >= 0;
}

bool read_fault(const std::vector<std::string>& words, ModbusFaults& faults) {
    double value = 0;
    std::string unit;
    if (words.size() < 2 ||
        !read_number(words[words.size() == 3 && words[0] != "late" ? 2 : 1], value, unit) ||
        !unit.empty()) {
        return false;
    }
    const std::string what =
        words.size() == 3 && words[0] != "late" ? words[0] + " " + words[1] : words[0];
    if (what == "seed") {
        faults.seed = static_cast<std::uint64_t>(value);
        return true;
    }
    if (what == "restart every") {
        faults.restart_every = static_cast<long>(value);
        return true;
    }
    // The others are chances.
    if (value > 1) {
        return false;
    }
    if (what == "drop before") {
        faults.drop_before = value;
    } else if (what == "drop after") {
        faults.drop_after = value;
    } else if (what == "corrupt") {
        faults.corrupt = value;
    } else if (what == "late" && words.size() == 3) {
        faults.late = value;
        if (!read_number(words[2], value, unit) || unit != "ms") {
            return false;
        }
        faults.late_by = Time(static_cast<Time::rep>(value * 1e6));
    } else {
        return false;
    }
    return true;
}

}  // namespace

tl::expected<ModbusFaults, std::string> read_modbus_faults(std::string_view script) {
    ModbusFaults faults;
    std::istringstream lines{std::string(script)};
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        std::istringstream stream(line.substr(0, line.find('#')));
        std::vector<std::string> words;
        for (std::string one; stream >> one;) {
            words.push_back(one);
        }
        if (!words.empty() && !read_fault(words, faults)) {
            return tl::make_unexpected("line " + std::to_string(number) +
                                       " of the faults cannot be read: '" + line + "'");
        }
    }
    return faults;
}

ModbusServer::ModbusServer(PlcOptions plc, Options options)
    : plc_(plc), options_(std::move(options)), random_(options_.faults.seed) {
    restart_at_ = options_.faults.restart_every;
}

ModbusServer::~ModbusServer() { stop(); }

bool ModbusServer::chance(double share) {
    // By hand: distributions of the library differ between its versions.
    constexpr double kSteps = 9007199254740992.0;
    return share > 0 && static_cast<double>(random_() >> 11U) < share * kSteps;
}

bool ModbusServer::listen_tcp() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(options_.port));
    if (::inet_pton(AF_INET, options_.host.c_str(), &address.sin_addr) != 1) {
        errno = EINVAL;
        return false;
    }
    listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    const int on = 1;
    ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    socklen_t size = sizeof address;
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    if (::bind(listener_, any, size) != 0 || ::listen(listener_, 4) != 0 ||
        ::getsockname(listener_, any, &size) != 0) {
        return false;
    }
    port_ = "tcp:" + options_.host + ":" + std::to_string(ntohs(address.sin_port));
    return true;
}

bool ModbusServer::open_terminal() {
    std::array<char, 128> name{};
    termios raw{};
    ::cfmakeraw(&raw);
    raw.c_cflag |= CLOCAL | CREAD | CS8;
    int master = -1;
    if (::openpty(&master, &slave_, name.data(), &raw, nullptr) != 0) {
        return false;
    }
    ::fcntl(master, F_SETFL, O_NONBLOCK);
    for (const int one : {master, slave_}) {
        ::fcntl(one, F_SETFD, FD_CLOEXEC);
    }
    peers_[master] = Peer{true, {}, {}};
    port_ = name.data();
    if (!options_.link.empty()) {
        ::unlink(options_.link.c_str());
        if (::symlink(name.data(), options_.link.c_str()) != 0) {
            return false;
        }
        port_ = options_.link;
    }
    return true;
}

tl::expected<void, std::string> ModbusServer::start() {
    wake_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (wake_ < 0 || !(options_.port >= 0 ? listen_tcp() : open_terminal())) {
        return tl::make_unexpected(std::string(std::strerror(errno)));
    }
    scan_at_ = time_now();
    thread_ = std::thread([this] { serve(); });
    return {};
}

void ModbusServer::stop() {
    if (thread_.joinable()) {
        stopping_ = true;
        const std::uint64_t one = 1;
        (void)!::write(wake_, &one, sizeof one);
        thread_.join();
    }
    for (const auto& [descriptor, peer] : peers_) {
        ::close(descriptor);
    }
    peers_.clear();
    for (int* descriptor : {&listener_, &slave_, &wake_}) {
        if (*descriptor >= 0) {
            ::close(*descriptor);
            *descriptor = -1;
        }
    }
    if (!options_.link.empty()) {
        ::unlink(options_.link.c_str());
    }
}

void ModbusServer::visit(const std::function<void(Plc&, Time)>& body) {
    const std::scoped_lock lock(mutex_);
    body(plc_, time_now());
}

void ModbusServer::serve() {
    while (!stopping_) {
        std::vector<pollfd> watched{pollfd{wake_, POLLIN, 0}};
        Time until = time_now() + 1s;
        {
            const std::scoped_lock lock(mutex_);
            const Time now = time_now();
            // Motion goes on also where scans are counted by requests.
            const Time gap = std::max<Time>(plc_.options().scan, 5ms);
            if (now >= scan_at_) {
                plc_.scan(now);
                scan_at_ = now + gap;
            }
            send_due(now);
            until = scan_at_;
            for (const Reply& reply : replies_) {
                until = std::min(until, reply.due);
            }
            if (listener_ >= 0) {
                watched.push_back({listener_, POLLIN, 0});
            }
            for (const auto& [descriptor, peer] : peers_) {
                watched.push_back({descriptor, POLLIN, 0});
            }
        }
        const Time left = std::max<Time>(until - time_now(), Time(0));
        const timespec wait{left / 1s, (left % Time(1s)).count()};
        ::ppoll(watched.data(), watched.size(), &wait, nullptr);
        const std::scoped_lock lock(mutex_);
        for (std::size_t i = 1; i < watched.size(); ++i) {
            if (watched[i].revents == 0) {
                continue;
            }
            if (watched[i].fd == listener_) {
                accept_peer();
            } else if (!hear(watched[i].fd, time_now())) {
                drop_peer(watched[i].fd);
            }
        }
    }
}

void ModbusServer::accept_peer() {
    const int descriptor = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (descriptor >= 0) {
        const int on = 1;
        ::setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
        peers_[descriptor] = Peer{};
    }
}

void ModbusServer::drop_peer(int descriptor) {
    const auto found = peers_.find(descriptor);
    if (found == peers_.end() || found->second.rtu) {
        return;
    }
    ::close(descriptor);
    peers_.erase(found);
    std::erase_if(replies_, [&](const Reply& one) { return one.descriptor == descriptor; });
}

/// False: the peer is gone, or is to go.
bool ModbusServer::hear(int descriptor, Time now) {
    const auto found = peers_.find(descriptor);
    if (found == peers_.end()) {
        return true;
    }
    Peer& peer = found->second;
    std::array<char, kMostBytes> bytes{};
    const ssize_t got = ::read(descriptor, bytes.data(), bytes.size());
    if (got <= 0) {
        return got < 0 && (errno == EAGAIN || errno == EINTR || peer.rtu);
    }
    if (peer.rtu && now - peer.last > 20ms) {
        peer.in.clear();  // frames end with silence
    }
    peer.last = now;
    peer.in.append(bytes.data(), static_cast<std::size_t>(got));
    take_frames(descriptor, peer, now);
    return peers_.count(descriptor) != 0;
}

void ModbusServer::take_frames(int descriptor, Peer& peer, Time now) {
    while (true) {
        if (peer.rtu) {
            const std::size_t length = rtu_length(peer.in);
            if (length == 0 || peer.in.size() < length) {
                return;
            }
            std::string whole = peer.in.substr(0, length);
            peer.in.erase(0, length);
            if (chance(options_.faults.corrupt / 2)) {
                whole[random_() % whole.size()] ^= static_cast<char>(1 + random_() % 255);
            }
            const std::uint16_t crc = crc16(std::string_view(whole).substr(0, length - 2));
            if ((at(whole, length - 2) | at(whole, length - 1) << 8U) != crc) {
                peer.in.clear();
                return;
            }
            if (at(whole, 0) == static_cast<unsigned>(options_.unit)) {
                frame(descriptor, true, whole.substr(0, 1), whole.substr(1, length - 3), now);
            }
            continue;
        }
        constexpr std::size_t kHeader = 7;
        if (peer.in.size() < kHeader) {
            return;
        }
        const std::size_t length = word(peer.in, 4);
        if (word(peer.in, 2) != 0 || length < 2 || length > 254) {
            drop_peer(descriptor);
            return;
        }
        if (peer.in.size() < 6 + length) {
            return;
        }
        std::string head = peer.in.substr(0, kHeader);
        const std::string pdu = peer.in.substr(kHeader, length - 1);
        peer.in.erase(0, 6 + length);
        if (!frame(descriptor, false, std::move(head), pdu, now)) {
            return;
        }
    }
}

/// One request. False: the connection is gone, and the peer with it.
bool ModbusServer::frame(int descriptor, bool rtu, std::string head, const std::string& pdu,
                         Time now) {
    ++requests_;
    const ModbusFaults& faults = options_.faults;
    if (chance(faults.drop_before)) {
        drop_peer(descriptor);
        return rtu;
    }
    const std::size_t asked = pdu.size();
    const std::string answer = carry_out(pdu, now);
    if (plc_.options().scan == Time(0)) {
        plc_.scan(now);
    }
    if (faults.restart_every > 0 && plc_.executed() >= static_cast<std::uint32_t>(restart_at_)) {
        plc_.restart(now);
        restart_at_ = static_cast<long>(plc_.executed()) + faults.restart_every;
        drop_peer(descriptor);
        return rtu;
    }
    if (chance(faults.drop_after)) {
        drop_peer(descriptor);
        return rtu;
    }
    std::string bytes = std::move(head);
    if (rtu) {
        bytes += answer;
        const std::uint16_t crc = crc16(bytes);
        bytes += static_cast<char>(crc & 0xFFU);
        bytes += static_cast<char>(crc >> 8U);
        if (chance(faults.corrupt / 2)) {
            bytes[random_() % bytes.size()] ^= static_cast<char>(1 + random_() % 255);
        }
    } else {
        bytes[4] = static_cast<char>((answer.size() + 1) >> 8U);
        bytes[5] = static_cast<char>((answer.size() + 1) & 0xFFU);
        bytes += answer;
    }
    Time due = now;
    if (chance(faults.late)) {
        due +=
            Time(static_cast<Time::rep>(random_() % static_cast<std::uint64_t>(std::max<Time::rep>(
                                                        faults.late_by.count(), 1))));
    }
    if (options_.baud > 0) {
        const double characters = static_cast<double>(asked + 3 + bytes.size()) + 7;
        due += Time(static_cast<Time::rep>(characters * 11e9 / static_cast<double>(options_.baud)));
    }
    replies_.push_back({due, descriptor, bytes});
    send_due(now);
    return true;
}

void ModbusServer::send_due(Time now) {
    std::erase_if(replies_, [&](const Reply& reply) {
        if (reply.due > now) {
            return false;
        }
        if (slave_ >= 0) {
            (void)!::write(reply.descriptor, reply.bytes.data(), reply.bytes.size());
        } else {
            (void)::send(reply.descriptor, reply.bytes.data(), reply.bytes.size(), MSG_NOSIGNAL);
        }
        return true;
    });
}

std::string ModbusServer::carry_out(const std::string& pdu, Time /*now*/) {
    constexpr int kIllegalFunction = 1;
    constexpr int kIllegalValue = 3;
    const unsigned function = at(pdu, 0);
    const bool known = function == 3 || function == 4 || function == 16 ||
                       (function == 23 && plc_.options().combined);
    if (!known) {
        return exception(function, kIllegalFunction);
    }
    std::vector<std::uint16_t> values;
    if (pdu.size() < 5 || (function >= 16 && !read_values(pdu, function == 16 ? 5 : 9, values))) {
        return exception(function, kIllegalValue);
    }
    if (function >= 16) {
        if (const int code = plc_.write(word(pdu, function == 16 ? 1 : 5), values); code != 0) {
            return exception(function, code);
        }
        if (function == 16) {
            return pdu.substr(0, 5);
        }
    }
    std::vector<std::uint16_t> read;
    if (const int code = plc_.read(word(pdu, 1), word(pdu, 3), read); code != 0) {
        return exception(function, code);
    }
    std::string answer{static_cast<char>(function), static_cast<char>(2 * read.size())};
    for (const std::uint16_t value : read) {
        add(answer, value);
    }
    return answer;
}

}  // namespace cam::sim
