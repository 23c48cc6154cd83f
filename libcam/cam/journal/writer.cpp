// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/journal/journal.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <optional>
#include <thread>

namespace cam::journal {

using Clock = std::chrono::steady_clock;

namespace {

constexpr std::chrono::milliseconds kGather{5};

tl::unexpected<decomp::Error> unwritable(const std::filesystem::path& path, int error_number) {
    return decomp::fail("file.unwritable",
                        std::string("cannot write the journal: ") + std::strerror(error_number),
                        path.string(), "check the folder, its permissions and the free space");
}

}  // namespace

struct Writer::State {
    std::filesystem::path path;
    Options options;
    int file = -1;

    mutable std::mutex mutex;
    std::condition_variable work;
    std::condition_variable done;
    std::string waiting;                ///< whole records, not yet written
    std::optional<std::string> latest;  ///< text of the newest note
    std::uint64_t added = 0;
    std::uint64_t written = 0;
    std::uint64_t durable = 0;
    std::uint64_t unsynced_count = 0;  ///< records and noted lines since the last sync
    bool urgent = false;
    bool closing = false;
    int error_number = 0;
    std::thread thread;

    void take_latest() {
        if (latest) {
            waiting += record_line(added++, *latest);
            latest.reset();
        }
    }

    bool write_out(const std::string& bytes) const {
        std::string_view rest = bytes;
        while (!rest.empty()) {
            const ssize_t sent = ::write(file, rest.data(), rest.size());
            if (sent < 0 && errno != EINTR) {
                return false;
            }
            rest.remove_prefix(sent > 0 ? static_cast<std::size_t>(sent) : 0);
        }
        return true;
    }

    [[nodiscard]] bool has_work() const { return closing || latest || !waiting.empty() || urgent; }

    void serve() {
        std::unique_lock lock(mutex);
        Clock::time_point oldest = Clock::now();
        bool dirty = false;
        while (true) {
            if (dirty) {
                work.wait_until(lock, oldest + options.sync_time, [&] { return has_work(); });
            } else {
                work.wait(lock, [&] { return has_work(); });
            }
            if (latest && !urgent && !closing) {
                // More notes are likely to follow at once.
                work.wait_for(lock, kGather, [&] { return urgent || closing; });
            }
            take_latest();
            std::string bytes;
            bytes.swap(waiting);
            const std::uint64_t records = added;
            if (!bytes.empty() && !dirty) {
                oldest = Clock::now();
                dirty = true;
            }
            const bool sync = dirty && (urgent || closing || unsynced_count >= options.sync_count ||
                                        Clock::now() >= oldest + options.sync_time);
            urgent = false;
            if (sync) {
                unsynced_count = 0;
            }
            lock.unlock();
            const bool failed = !write_out(bytes) || (sync && ::fdatasync(file) != 0);
            const int reason = failed ? errno : 0;
            lock.lock();
            written = records;
            if (failed) {
                error_number = reason;
            } else if (sync) {
                durable = records;
                dirty = false;
            }
            done.notify_all();
            if ((sync || failed) && options.on_synced) {
                lock.unlock();
                options.on_synced();
                lock.lock();
            }
            if (failed || (closing && waiting.empty() && !latest)) {
                return;
            }
        }
    }
};

Writer::Writer(std::unique_ptr<State> state) : state_(std::move(state)) {
    state_->thread = std::thread([this] { state_->serve(); });
}

Writer::~Writer() {
    {
        const std::scoped_lock lock(state_->mutex);
        state_->closing = true;
    }
    state_->work.notify_all();
    state_->thread.join();
    ::close(state_->file);
}

decomp::Result<std::unique_ptr<Writer>> Writer::create(const std::filesystem::path& path,
                                                       Options options) {
    auto state = std::make_unique<State>();
    state->path = path;
    state->options = std::move(options);
    state->file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
    if (state->file < 0) {
        const int error_number = errno;
        if (error_number == EEXIST) {
            return decomp::fail("file.exists", "the journal exists already", path.string(),
                                "continue the job with --resume, or begin anew with --force");
        }
        return unwritable(path, error_number);
    }
    return std::unique_ptr<Writer>(new Writer(std::move(state)));
}

decomp::Result<std::unique_ptr<Writer>> Writer::append(const std::filesystem::path& path,
                                                       const Contents& contents, Options options) {
    auto state = std::make_unique<State>();
    state->path = path;
    state->options = std::move(options);
    state->added = state->written = state->durable = contents.records.size();
    state->file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (state->file < 0 ||
        ::ftruncate(state->file, static_cast<off_t>(contents.whole_bytes)) != 0) {
        const int error_number = errno;
        if (state->file >= 0) {
            ::close(state->file);
        }
        return unwritable(path, error_number);
    }
    return std::unique_ptr<Writer>(new Writer(std::move(state)));
}

std::uint64_t Writer::add(std::string_view text, Urgency urgency) {
    std::uint64_t number = 0;
    {
        const std::scoped_lock lock(state_->mutex);
        state_->take_latest();
        number = state_->added++;
        state_->waiting += record_line(number, text);
        state_->urgent = state_->urgent || urgency == Urgency::Urgent;
        ++state_->unsynced_count;
    }
    state_->work.notify_one();
    return number;
}

void Writer::note(std::string text, std::uint64_t lines) {
    bool first = false;
    {
        const std::scoped_lock lock(state_->mutex);
        first = !state_->latest;
        state_->latest = std::move(text);
        state_->unsynced_count += lines;
    }
    if (first) {
        state_->work.notify_one();
    }
}

std::uint64_t Writer::durable() const {
    const std::scoped_lock lock(state_->mutex);
    return state_->durable;
}

decomp::Status Writer::status() const {
    const std::scoped_lock lock(state_->mutex);
    if (state_->error_number != 0) {
        return unwritable(state_->path, state_->error_number);
    }
    return {};
}

decomp::Status Writer::flush() {
    {
        std::unique_lock lock(state_->mutex);
        state_->take_latest();
        state_->urgent = true;
        const std::uint64_t wanted = state_->added;
        state_->work.notify_one();
        state_->done.wait(lock,
                          [&] { return state_->durable >= wanted || state_->error_number != 0; });
    }
    return status();
}

}  // namespace cam::journal
