#include "twin/app/ask.h"

#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "models/base/error.h"
#include "twin/app/command_line/terminal.h"

namespace tubetwin {

void RequireWord(const Asked& asked, bool yes) {
  if (yes) return;
  if (::isatty(STDIN_FILENO) != 1) {
    throw Error(ErrorKind::kUsage, asked.verb + ": nobody is at a terminal to say that " +
                                       asked.what +
                                       "; allowed is a person there, or --yes from one who sees "
                                       "it; nothing was sent");
  }
  std::fprintf(stderr, "%s When nobody is near, type '%s': ", ForTerminal(asked.told).c_str(),
               asked.word.c_str());
  std::string answer;
  std::getline(std::cin, answer);
  if (answer != asked.word) throw Error(ErrorKind::kInterrupted, asked.verb + ": not moved");
}

}  // namespace tubetwin
