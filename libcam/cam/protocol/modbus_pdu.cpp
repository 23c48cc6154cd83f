// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/protocol/modbus_pdu.h"

namespace cam::protocol {

namespace {

constexpr std::uint8_t kWrite = 16;
constexpr std::uint8_t kExchange = 23;
constexpr std::uint8_t kException = 0x80;

void put(std::string& bytes, std::uint16_t word) {
    bytes.push_back(static_cast<char>(word >> 8U));
    bytes.push_back(static_cast<char>(word & 0xFFU));
}

std::uint8_t byte_at(std::string_view bytes, std::size_t index) {
    return static_cast<std::uint8_t>(bytes[index]);
}

std::uint16_t word_at(std::string_view bytes, std::size_t index) {
    return static_cast<std::uint16_t>(byte_at(bytes, index) << 8U | byte_at(bytes, index + 1));
}

std::string framed(std::uint8_t tag, const std::string& pdu) {
    std::string bytes;
    put(bytes, static_cast<std::uint16_t>(pdu.size() + 1));
    bytes.push_back(static_cast<char>(tag));
    return bytes + pdu;
}

void put_values(std::string& pdu, std::uint16_t address, const Registers& values) {
    put(pdu, address);
    put(pdu, static_cast<std::uint16_t>(values.size()));
    pdu.push_back(static_cast<char>(2 * values.size()));
    for (const std::uint16_t value : values) {
        put(pdu, value);
    }
}

ModbusAnswer read_answer(std::string_view frame) {
    ModbusAnswer answer;
    answer.no_answer = NoAnswer::Garbled;
    if (frame.size() < 3) {
        return answer;
    }
    answer.tag = byte_at(frame, 0);
    const std::uint8_t function = byte_at(frame, 1);
    const std::uint8_t first = byte_at(frame, 2);
    if (function == 0) {
        if (first >= 1 && first <= 3) {
            answer.no_answer = static_cast<NoAnswer>(first);
        }
    } else if ((function & kException) != 0) {
        if (first != 0 && frame.size() == 3) {
            answer.no_answer.reset();
            answer.exception = first;
        }
    } else if (function == kWrite) {
        if (frame.size() == 6) {
            answer.no_answer.reset();
        }
    } else if (function == 3 || function == 4 || function == kExchange) {
        if (first % 2 == 0 && frame.size() == 3U + first) {
            answer.no_answer.reset();
            for (std::size_t at = 3; at < frame.size(); at += 2) {
                answer.registers.push_back(word_at(frame, at));
            }
        }
    }
    return answer;
}

}  // namespace

std::string read_request(std::uint8_t tag, std::uint8_t function, const RegisterSpan& span) {
    std::string pdu(1, static_cast<char>(function));
    put(pdu, span.address);
    put(pdu, span.count);
    return framed(tag, pdu);
}

std::string write_request(std::uint8_t tag, std::uint16_t address, const Registers& values) {
    std::string pdu(1, static_cast<char>(kWrite));
    put_values(pdu, address, values);
    return framed(tag, pdu);
}

std::string exchange_request(std::uint8_t tag, std::uint16_t address, const Registers& values,
                             std::uint16_t read_address, std::uint16_t read_count) {
    std::string pdu(1, static_cast<char>(kExchange));
    put(pdu, read_address);
    put(pdu, read_count);
    put_values(pdu, address, values);
    return framed(tag, pdu);
}

void AnswerReader::add(std::string_view bytes) {
    bytes_.erase(0, begin_);
    begin_ = 0;
    bytes_ += bytes;
}

std::optional<ModbusAnswer> AnswerReader::next() {
    const std::string_view rest = std::string_view(bytes_).substr(begin_);
    if (rest.size() < 2) {
        return std::nullopt;
    }
    const std::size_t length = word_at(rest, 0);
    if (rest.size() < 2 + length) {
        return std::nullopt;
    }
    begin_ += 2 + length;
    return read_answer(rest.substr(2, length));
}

}  // namespace cam::protocol
