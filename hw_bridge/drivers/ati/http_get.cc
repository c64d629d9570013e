#include "hw_bridge/drivers/ati/http_get.h"

#include <asio.hpp>

namespace tubetwin {
namespace {

constexpr std::size_t kMaxHead = 8192, kMaxBody = 65536;

std::variant<std::string, DecodeError> BodyOf(const std::string& answer) {
  const std::size_t line_end = answer.find("\r\n");
  const std::string line = answer.substr(0, std::min<std::size_t>(line_end, 80));
  if (!line.starts_with("HTTP/1.") || line_end == std::string::npos) {
    return DecodeError{"the answer is no HTTP"};
  }
  if (line.find(" 200") != 8) return DecodeError{"the answer is \"" + line + "\""};
  const std::size_t head_end = answer.find("\r\n\r\n");
  if (head_end == std::string::npos) return DecodeError{"the answer ends in its header"};
  return answer.substr(head_end + 4);
}

}  // namespace

std::variant<std::string, DecodeError> HttpGet(const std::string& host, int port,
                                               const std::string& path,
                                               std::chrono::nanoseconds limit) {
  using asio::ip::tcp;
  asio::io_context io;
  tcp::resolver resolver(io);
  tcp::socket socket(io);
  const std::string request = "GET " + path + " HTTP/1.0\r\nHost: " + host + "\r\n\r\n";
  std::string answer;
  asio::error_code result = asio::error::timed_out;
  const auto received = [&](asio::error_code error, std::size_t) {
    result = error == asio::error::eof ? asio::error_code() : error;
  };
  const auto sent = [&](asio::error_code error, std::size_t) {
    if (error) {
      result = error;
      return;
    }
    asio::async_read(socket, asio::dynamic_buffer(answer, kMaxHead + kMaxBody), received);
  };
  const auto connected = [&](asio::error_code error, const tcp::endpoint&) {
    if (error) {
      result = error;
      return;
    }
    asio::async_write(socket, asio::buffer(request), sent);
  };
  resolver.async_resolve(host, std::to_string(port),
                         [&](asio::error_code error, const tcp::resolver::results_type& found) {
                           if (error) {
                             result = error;
                             return;
                           }
                           asio::async_connect(socket, found, connected);
                         });
  io.run_for(limit);
  if (!io.stopped()) return DecodeError{"no whole answer in time"};
  if (result) return DecodeError{result.message()};
  return BodyOf(answer);
}

}  // namespace tubetwin
