// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/virtual_machine.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/eventfd.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>

namespace cam::sim {

using namespace std::chrono_literals;

namespace {

constexpr std::size_t kMostUnsent = 65536;
constexpr Time kStep = 200us;

}  // namespace

VirtualMachine::VirtualMachine(std::unique_ptr<Board> board, Options options)
    : board_(std::move(board)),
      options_(std::move(options)),
      wire_(options_.faults, options_.baud) {}

VirtualMachine::~VirtualMachine() { stop(); }

Time VirtualMachine::now() { return std::chrono::steady_clock::now().time_since_epoch(); }

bool VirtualMachine::open_terminal() {
    std::array<char, 128> name{};
    termios raw{};
    ::cfmakeraw(&raw);
    ::cfsetspeed(&raw, B115200);
    raw.c_cflag |= CLOCAL | CREAD | CS8;
    if (::openpty(&master_, &slave_, name.data(), &raw, nullptr) != 0) {
        master_ = slave_ = -1;
        return false;
    }
    for (const int descriptor : {master_, slave_}) {
        ::fcntl(descriptor, F_SETFD, FD_CLOEXEC);
    }
    ::fcntl(master_, F_SETFL, O_NONBLOCK);
    terminal_ = name.data();
    if (!options_.link.empty()) {
        // Made beside and renamed, so that the name is never absent.
        const std::string fresh = options_.link + ".new";
        ::unlink(fresh.c_str());
        if (::symlink(terminal_.c_str(), fresh.c_str()) != 0 ||
            ::rename(fresh.c_str(), options_.link.c_str()) != 0) {
            return false;
        }
    }
    return true;
}

void VirtualMachine::close_terminal() {
    for (int* descriptor : {&slave_, &master_}) {
        if (*descriptor >= 0) {
            ::close(*descriptor);
            *descriptor = -1;
        }
    }
    unsent_.clear();
}

tl::expected<void, std::string> VirtualMachine::start() {
    wake_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (wake_ < 0 || !open_terminal()) {
        return tl::make_unexpected(std::string(std::strerror(errno)));
    }
    if (options_.banner) {
        board_->reset(now());
    }
    thread_ = std::thread([this] { serve(); });
    return {};
}

void VirtualMachine::stop() {
    if (thread_.joinable()) {
        stopping_ = true;
        const std::uint64_t one = 1;
        (void)!::write(wake_, &one, sizeof one);
        thread_.join();
    }
    close_terminal();
    if (wake_ >= 0) {
        ::close(wake_);
        wake_ = -1;
    }
    if (!options_.link.empty()) {
        ::unlink(options_.link.c_str());
    }
}

std::string VirtualMachine::port() const {
    const std::scoped_lock lock(mutex_);
    return options_.link.empty() ? terminal_ : options_.link;
}

void VirtualMachine::visit(const std::function<void(Board&, Wire&, Time)>& body) {
    const std::scoped_lock lock(mutex_);
    body(*board_, wire_, now());
    const std::uint64_t one = 1;
    (void)!::write(wake_, &one, sizeof one);
}

void VirtualMachine::unplug(Time duration) {
    const std::scoped_lock lock(mutex_);
    pull_cable(duration);
}

void VirtualMachine::pull_cable(Time duration) {
    close_terminal();
    wire_.cut();
    unplugged_ = true;
    plug_at_ = now() + duration;
}

Time VirtualMachine::idle_time() {
    std::optional<Time> soonest = board_->next();
    const auto consider = [&](std::optional<Time> when) {
        if (when) {
            soonest = std::min(soonest.value_or(*when), *when);
        }
    };
    consider(wire_.next());
    if (unplugged_) {
        consider(plug_at_);
    }
    if (!soonest) {
        return 1s;
    }
    // A step of some bytes, or every byte would be a wake-up of its own.
    return std::clamp(*soonest - now(), Time(kStep), Time(1s));
}

void VirtualMachine::exchange() {
    const Time at = now();
    if (unplugged_ && at >= plug_at_) {
        unplugged_ = !open_terminal();
        plug_at_ = at + 100ms;
    }
    if (!unplugged_) {
        std::array<char, 4096> bytes{};
        const ssize_t got = ::read(master_, bytes.data(), bytes.size());
        if (got > 0) {
            wire_.from_host({bytes.data(), static_cast<std::size_t>(got)}, at);
        }
    }
    board_->receive(wire_.to_board(at), at);
    board_->advance(at);
    wire_.from_board(board_->take_output(), at);
    if (wire_.reset_due()) {
        board_->reset(at);
        wire_.from_board(board_->take_output(), at);
    }
    if (!unplugged_) {
        unsent_ += wire_.to_host(at);
        if (unsent_.size() > kMostUnsent) {
            unsent_.clear();
        }
        const ssize_t sent = unsent_.empty() ? 0 : ::write(master_, unsent_.data(), unsent_.size());
        if (sent > 0) {
            unsent_.erase(0, static_cast<std::size_t>(sent));
        }
        if (wire_.unplug_due()) {
            pull_cable(wire_.faults().unplugged);
        }
    } else {
        (void)wire_.to_host(at);
    }
}

void VirtualMachine::serve() {
    while (!stopping_) {
        int master = -1;
        timespec wait{};
        bool writing = false;
        {
            const std::scoped_lock lock(mutex_);
            exchange();
            master = master_;
            writing = !unsent_.empty();
            const Time idle = idle_time();
            wait.tv_sec = idle / 1s;
            wait.tv_nsec = (idle % Time(1s)).count();
        }
        std::array<pollfd, 2> watched{
            pollfd{wake_, POLLIN, 0},
            pollfd{master, static_cast<short>(POLLIN | (writing ? POLLOUT : 0)), 0}};
        ::ppoll(watched.data(), master >= 0 ? 2 : 1, &wait, nullptr);
        if ((watched[0].revents & POLLIN) != 0) {
            std::uint64_t count = 0;
            (void)!::read(wake_, &count, sizeof count);
        }
    }
}

}  // namespace cam::sim
