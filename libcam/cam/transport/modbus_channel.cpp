// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/transport/channels_detail.h"
#include "cam/transport/modbus.h"

#include <modbus/modbus.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace cam::transport {

namespace {

using Clock = std::chrono::steady_clock;
using Context = std::unique_ptr<modbus_t, void (*)(modbus_t*)>;

constexpr std::array kBauds = {1200,  2400,   4800,   9600,   19200, 38400,
                               57600, 115200, 230400, 460800, 921600};
constexpr std::size_t kMostWaiting = 65536;
constexpr char kTimeout = 1;
constexpr char kGarbled = 2;
constexpr char kNoLink = 3;

unsigned byte_at(const std::string& bytes, std::size_t index) {
    return static_cast<unsigned char>(bytes.at(index));
}

unsigned word_at(const std::string& bytes, std::size_t index) {
    return byte_at(bytes, index) << 8U | byte_at(bytes, index + 1);
}

void put_word(std::string& bytes, unsigned word) {
    bytes.push_back(static_cast<char>(word >> 8U));
    bytes.push_back(static_cast<char>(word & 0xFFU));
}

/// What the machine was asked for, and room for the longest answer whatever it is: a hostile server
/// may send more than was asked for.
struct Carried {
    int rc = -1;
    std::array<std::uint16_t, 256> registers{};
};

class ModbusChannel final : public ByteChannel {
  public:
    ModbusChannel(Context context, LockFile lock, const ModbusSettings& settings, bool serial)
        : context_(std::move(context)),
          lock_(std::move(lock)),
          serial_(serial),
          wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
        constexpr double kBitsOfCharacter = 11;
        constexpr double kGapCharacters = 3.5;
        const double gap_s = std::max(kGapCharacters * kBitsOfCharacter / settings.baud, 0.00175);
        gap_ = serial ? std::chrono::microseconds(static_cast<long>(gap_s * 1e6))
                      : std::chrono::microseconds(0);
        thread_ = std::thread([this] { serve(); });
    }

    ModbusChannel(const ModbusChannel&) = delete;
    ModbusChannel& operator=(const ModbusChannel&) = delete;
    ModbusChannel(ModbusChannel&&) = delete;
    ModbusChannel& operator=(ModbusChannel&&) = delete;

    ~ModbusChannel() override {
        {
            const std::scoped_lock lock(mutex_);
            closing_ = true;
        }
        asked_.notify_one();
        thread_.join();
        modbus_close(context_.get());
        ::close(wake_);
    }

    [[nodiscard]] int descriptor() const override { return wake_; }

    [[nodiscard]] decomp::Result<std::size_t> read(char* bytes, std::size_t size) override {
        const std::scoped_lock lock(mutex_);
        const std::size_t count = std::min(size, answers_.size());
        std::copy_n(answers_.begin(), count, bytes);
        answers_.erase(0, count);
        if (answers_.empty()) {
            std::uint64_t woken = 0;
            (void)!::read(wake_, &woken, sizeof woken);
        }
        return count;
    }

    [[nodiscard]] decomp::Result<std::size_t> write(std::string_view bytes) override {
        {
            const std::scoped_lock lock(mutex_);
            if (requests_.size() > kMostWaiting) {
                return std::size_t{0};
            }
            requests_ += bytes;
        }
        asked_.notify_one();
        return bytes.size();
    }

    void discard_output() override {
        const std::scoped_lock lock(mutex_);
        requests_.clear();
    }

    [[nodiscard]] std::string_view kind() const override { return "libmodbus"; }

  private:
    /// The oldest whole request; empty when the channel closes.
    std::string next_request() {
        std::unique_lock lock(mutex_);
        const auto whole = [&] {
            return requests_.size() >= 2 && requests_.size() >= 2 + word_at(requests_, 0);
        };
        asked_.wait(lock, [&] { return closing_ || whole(); });
        if (closing_) {
            return {};
        }
        const std::size_t length = word_at(requests_, 0);
        std::string request = requests_.substr(2, length);
        requests_.erase(0, 2 + length);
        return request;
    }

    void serve() {
        while (true) {
            const std::string request = next_request();
            if (request.empty()) {
                const std::scoped_lock lock(mutex_);
                if (closing_) {
                    return;
                }
                continue;
            }
            const std::string pdu = carry_out(request);
            std::string answer;
            put_word(answer, static_cast<unsigned>(pdu.size() + 1));
            answer.push_back(request.front());
            answer += pdu;
            const std::scoped_lock lock(mutex_);
            answers_ += answer;
            const std::uint64_t one = 1;
            (void)!::write(wake_, &one, sizeof one);
        }
    }

    std::string carry_out(const std::string& request) {
        constexpr std::size_t kShortest = 6;
        if (request.size() < kShortest) {
            return {'\0', kGarbled};
        }
        if (broken_ && !mend()) {
            return {'\0', kNoLink};
        }
        std::this_thread::sleep_until(quiet_until_);
        const Carried carried = call(request);
        const int error = errno;
        quiet_until_ = Clock::now() + gap_;
        if (carried.rc >= 0) {
            return answered(request, carried);
        }
        if (error > MODBUS_ENOBASE && error < MODBUS_ENOBASE + MODBUS_EXCEPTION_MAX) {
            return {static_cast<char>(byte_at(request, 1) | 0x80U),
                    static_cast<char>(error - MODBUS_ENOBASE)};
        }
        broken_ = true;
        gone_ = error == EIO || error == ENODEV || error == EBADF || error == ENXIO;
        return {'\0', error == ETIMEDOUT ? kTimeout : error >= EMBBADCRC ? kGarbled : kNoLink};
    }

    Carried call(const std::string& request) {
        Carried out;
        const auto address = static_cast<int>(word_at(request, 2));
        const auto count = static_cast<int>(word_at(request, 4));
        errno = EMBBADDATA;
        switch (byte_at(request, 1)) {
            case 3:
                out.rc =
                    modbus_read_registers(context_.get(), address, count, out.registers.data());
                break;
            case 4:
                out.rc = modbus_read_input_registers(context_.get(), address, count,
                                                     out.registers.data());
                break;
            case 16:
                if (const auto values = values_of(request, 6); values) {
                    out.rc = modbus_write_registers(context_.get(), address, count, values->data());
                }
                break;
            case 23:
                if (const auto values = values_of(request, 10); values) {
                    out.rc = modbus_write_and_read_registers(
                        context_.get(), static_cast<int>(word_at(request, 6)),
                        static_cast<int>(word_at(request, 8)), values->data(), address, count,
                        out.registers.data());
                }
                break;
            default:
                break;
        }
        return out;
    }

    /// The values of a request whose byte count stands at `index`.
    static std::optional<std::vector<std::uint16_t>> values_of(const std::string& request,
                                                               std::size_t index) {
        if (request.size() <= index || request.size() != index + 1 + byte_at(request, index) ||
            word_at(request, index - 2) * 2 != byte_at(request, index)) {
            return std::nullopt;
        }
        std::vector<std::uint16_t> values;
        for (std::size_t at = index + 1; at + 1 < request.size(); at += 2) {
            values.push_back(static_cast<std::uint16_t>(word_at(request, at)));
        }
        return values;
    }

    static std::string answered(const std::string& request, const Carried& carried) {
        std::string pdu(1, request.at(1));
        if (byte_at(request, 1) == 16) {
            return pdu + request.substr(2, 4);
        }
        // rc is what was asked for, or libmodbus had called it an error.
        const auto count = static_cast<std::size_t>(carried.rc);
        pdu.push_back(static_cast<char>(2 * count));
        for (std::size_t i = 0; i < count; ++i) {
            put_word(pdu, carried.registers.at(i));
        }
        return pdu;
    }

    /// Makes a link usable again after any error: nothing that is still on its way may be taken for
    /// the answer to a later request.
    bool mend() {
        if (serial_ && !gone_) {
            while (modbus_flush(context_.get()) > 0) {
                std::this_thread::sleep_for(gap_);
            }
        } else {
            modbus_close(context_.get());
            if (modbus_connect(context_.get()) != 0) {
                return false;
            }
        }
        broken_ = gone_ = false;
        return true;
    }

    Context context_;
    LockFile lock_;
    bool serial_;
    std::chrono::microseconds gap_{};
    int wake_;
    std::mutex mutex_;
    std::condition_variable asked_;
    bool closing_ = false;
    std::string requests_;
    std::string answers_;
    // Of the thread alone:
    bool broken_ = false;
    bool gone_ = false;  ///< the device is no longer there
    Clock::time_point quiet_until_{};
    std::thread thread_;
};

struct TcpName {
    std::string host;
    std::string service;
};

std::optional<TcpName> tcp_name(const std::string& port) {
    constexpr std::string_view kTcp = "tcp:";
    if (!port.starts_with(kTcp)) {
        return std::nullopt;
    }
    const std::size_t colon = port.rfind(':');
    if (colon < kTcp.size()) {
        return TcpName{port.substr(kTcp.size()), "502"};
    }
    return TcpName{port.substr(kTcp.size(), colon - kTcp.size()), port.substr(colon + 1)};
}

detail::ChannelResult connected(Context context, LockFile lock, const ModbusSettings& settings,
                                const std::string& port, bool serial) {
    if (!context) {
        return decomp::fail("transport.bad_name", "libmodbus does not take this port", port);
    }
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(settings.timeout);
    const auto rest = std::chrono::microseconds(settings.timeout - seconds);
    modbus_set_response_timeout(context.get(), static_cast<std::uint32_t>(seconds.count()),
                                static_cast<std::uint32_t>(rest.count()));
    modbus_set_byte_timeout(context.get(), static_cast<std::uint32_t>(seconds.count()),
                            static_cast<std::uint32_t>(rest.count()));
    modbus_set_error_recovery(context.get(), MODBUS_ERROR_RECOVERY_NONE);
    if (modbus_set_slave(context.get(), settings.unit) != 0) {
        return decomp::fail("transport.bad_name", "a Modbus unit is a number from 1 to 247", port);
    }
    if (modbus_connect(context.get()) != 0) {
        return detail::not_opened(port, errno);
    }
    return std::make_unique<ModbusChannel>(std::move(context), std::move(lock), settings, serial);
}

}  // namespace

decomp::Result<std::unique_ptr<ByteChannel>> open_modbus(const std::string& port,
                                                         const ModbusSettings& settings) {
    if (const auto name = tcp_name(port)) {
        auto lock = LockFile::take("modbus-" + name->host + "-" + name->service + "-" +
                                   std::to_string(settings.unit));
        if (!lock) {
            return decomp::fail(lock.error());
        }
        Context context(modbus_new_tcp_pi(name->host.c_str(), name->service.c_str()), modbus_free);
        return connected(std::move(context), std::move(*lock), settings, port, false);
    }
    if (std::find(kBauds.begin(), kBauds.end(), settings.baud) == kBauds.end()) {
        // libmodbus would take 9600 instead and say nothing.
        return decomp::fail("transport.bad_name",
                            "libmodbus does not know " + std::to_string(settings.baud) + " baud",
                            port, "usual rates from 1200 to 921600");
    }
    std::error_code error;
    const std::filesystem::path device = std::filesystem::canonical(port, error);
    if (error) {
        return detail::not_opened(port, error.value());
    }
    auto lock = LockFile::take(device);
    if (!lock) {
        return decomp::fail(lock.error());
    }
    Context context(
        modbus_new_rtu(device.c_str(), settings.baud, settings.parity, 8, settings.stop_bits),
        modbus_free);
    return connected(std::move(context), std::move(*lock), settings, port, true);
}

}  // namespace cam::transport
