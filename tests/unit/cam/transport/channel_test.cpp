// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/transport/channel.h"

#include "cam/transport/lock.h"
#include "cam/transport/ports.h"
#include "tests/support/temp_dir.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

namespace {

using namespace cam::transport;

struct Pty {
    int master = -1;
    int slave = -1;
    std::string name;

    Pty() {
        std::array<char, 100> text{};
        EXPECT_EQ(::openpty(&master, &slave, text.data(), nullptr, nullptr), 0);
        name = text.data();
    }

    Pty(const Pty&) = delete;
    Pty& operator=(const Pty&) = delete;

    ~Pty() {
        ::close(master);
        ::close(slave);
    }
};

bool readable(const ByteChannel& channel) {
    pollfd watched{channel.descriptor(), POLLIN, 0};
    return ::poll(&watched, 1, 2000) == 1;
}

/// Whether the line hangs up (DTR drops) when the last program closes it.
bool hangs_up(const Pty& pty) {
    termios modes{};
    EXPECT_EQ(::tcgetattr(pty.slave, &modes), 0);
    return (modes.c_cflag & HUPCL) != 0;
}

TEST(Channel, ABoardIsNotResetByClosingItsPortUnlessItIsAskedFor) {
    const Pty pty;
    termios modes{};
    ASSERT_EQ(::tcgetattr(pty.slave, &modes), 0);
    modes.c_cflag |= HUPCL;
    ASSERT_EQ(::tcsetattr(pty.slave, TCSANOW, &modes), 0);
    { ASSERT_TRUE(open_channel(pty.name, {})); }
    EXPECT_FALSE(hangs_up(pty));
    { ASSERT_TRUE(open_channel(pty.name, {.reset_on_close = true})); }
    EXPECT_TRUE(hangs_up(pty));
}

TEST(Channel, WhatWasSaidBeforeItWasOpenedIsNotRead) {
    const Pty pty;
    ASSERT_EQ(::write(pty.master, "stale\n", 6), 6);
    const auto channel = open_channel(pty.name, {});
    ASSERT_TRUE(channel);
    ASSERT_EQ(::write(pty.master, "ok\n", 3), 3);
    ASSERT_TRUE(readable(**channel));
    std::array<char, 64> bytes{};
    const auto got = (*channel)->read(bytes.data(), bytes.size());
    ASSERT_TRUE(got);
    EXPECT_EQ(std::string_view(bytes.data(), *got), "ok\n");
}

TEST(Channel, BytesPassUnchangedBothWays) {
    const Pty pty;
    auto channel = open_channel(pty.name, {.baud = 250000});
    ASSERT_TRUE(channel) << channel.error().text();
    const std::string all = [] {
        std::string out;
        for (int i = 1; i < 256; ++i) {
            out += static_cast<char>(i);
        }
        return out;
    }();
    ASSERT_EQ((*channel)->write(all).value(), all.size());
    std::array<char, 512> bytes{};
    ASSERT_EQ(::read(pty.master, bytes.data(), bytes.size()), static_cast<ssize_t>(all.size()));
    EXPECT_EQ(std::string(bytes.data(), all.size()), all);
    ASSERT_EQ(::write(pty.master, all.data(), all.size()), static_cast<ssize_t>(all.size()));
    ASSERT_TRUE(readable(**channel));
    EXPECT_EQ((*channel)->read(bytes.data(), bytes.size()).value(), all.size());
    EXPECT_EQ(std::string(bytes.data(), all.size()), all);
    EXPECT_EQ((*channel)->read(bytes.data(), bytes.size()).value(), 0U);
}

TEST(Channel, AStalledPeerMeansThatNothingIsWritten) {
    const Pty pty;
    auto channel = open_channel(pty.name, {});
    ASSERT_TRUE(channel);
    const std::string block(1000, 'x');
    std::size_t all = 0;
    for (int i = 0; i < 1000; ++i) {
        const auto sent = (*channel)->write(block);
        ASSERT_TRUE(sent);
        all += *sent;
        if (*sent == 0) {
            break;
        }
    }
    EXPECT_LT(all, 200000U);
}

TEST(Channel, APulledCableIsAnError) {
    Pty pty;
    auto channel = open_channel(pty.name, {});
    ASSERT_TRUE(channel);
    ::close(pty.slave);
    ::close(pty.master);
    pty.master = pty.slave = -1;
    ASSERT_TRUE(readable(**channel));
    std::array<char, 16> bytes{};
    const auto got = (*channel)->read(bytes.data(), bytes.size());
    ASSERT_FALSE(got);
    EXPECT_EQ(got.error().code, "transport.unplugged");
}

TEST(Channel, ASecondSenderIsToldWhoHoldsThePort) {
    const Pty pty;
    auto first = open_channel(pty.name, {});
    ASSERT_TRUE(first);
    auto second = open_channel(pty.name, {});
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, "transport.busy");
    if (std::filesystem::is_directory("/run/lock")) {
        EXPECT_NE(second.error().message.find(std::to_string(::getpid())), std::string::npos);
    }
    first->reset();
    EXPECT_TRUE(open_channel(pty.name, {}));
}

TEST(Channel, LinksToAPortAreFollowed) {
    const Pty pty;
    const tests::TempDir folder;
    std::filesystem::create_symlink(pty.name, folder / "by-id");
    EXPECT_TRUE(open_channel(folder / "by-id", {}));
}

TEST(Channel, WhatIsNoPortIsSaidToBeNone) {
    const tests::TempDir folder;
    EXPECT_EQ(open_channel(folder / "nothing", {}).error().code, "transport.not_found");
    std::ofstream(folder / "file") << "text";
    EXPECT_EQ(open_channel(folder / "file", {}).error().code, "transport.bad_name");
    EXPECT_EQ(open_channel("tcp:nowhere", {}).error().code, "transport.bad_name");
}

TEST(Channel, TcpIsAPortToo) {
    const int server = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ASSERT_EQ(::bind(server, reinterpret_cast<sockaddr*>(&address), size), 0);
    ASSERT_EQ(::listen(server, 1), 0);
    ::getsockname(server, reinterpret_cast<sockaddr*>(&address), &size);
    auto channel = open_channel("tcp:127.0.0.1:" + std::to_string(ntohs(address.sin_port)), {});
    ASSERT_TRUE(channel) << channel.error().text();
    const int peer = ::accept(server, nullptr, nullptr);
    ASSERT_EQ((*channel)->write("?").value(), 1U);
    char byte = 0;
    ASSERT_EQ(::read(peer, &byte, 1), 1);
    EXPECT_EQ(byte, '?');
    ::close(peer);
    ASSERT_TRUE(readable(**channel));
    EXPECT_EQ((*channel)->read(&byte, 1).error().code, "transport.unplugged");
    ::close(server);
    EXPECT_FALSE(open_channel("tcp:127.0.0.1:" + std::to_string(ntohs(address.sin_port)), {}));
}

TEST(LockFile, OneOfADeadProcessIsTakenOver) {
    const tests::TempDir folder;
    std::ofstream(folder / "LCK..ttyTEST") << "   4194303\n";
    const auto lock = LockFile::take("/dev/ttyTEST", folder.path());
    ASSERT_TRUE(lock);
    EXPECT_EQ(lock->path(), folder / "LCK..ttyTEST");
    EXPECT_EQ(LockFile::take("/dev/ttyTEST", folder.path()).error().code, "transport.busy");
}

TEST(Ports, CanBeListed) {
    const auto ports = list_ports();
    ASSERT_TRUE(ports) << ports.error().text();
    for (const Port& port : *ports) {
        EXPECT_TRUE(port.name.starts_with("/dev/")) << port.name;
    }
}

}  // namespace
