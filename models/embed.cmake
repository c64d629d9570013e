# Turns text files into one C++ source, so that the program carries them and can be moved anywhere.
#   cmake -DOUTPUT=x.cc -DROOT=models -DFILES=arms/hc10.toml,parts/a.toml -P embed.cmake
# Run at build time; a changed file is compiled in again. Looked up by models/files/embedded.h.
string(REPLACE "," ";" FILES "${FILES}")
set(text "#include \"models/files/embedded.h\"\n\nnamespace tubetwin {\n\n")
string(APPEND text "const std::vector<EmbeddedText>& EmbeddedTexts() {\n")
string(APPEND text "  static const std::vector<EmbeddedText> texts = {\n")
foreach(file IN LISTS FILES)
  file(READ "${ROOT}/${file}" content)
  string(APPEND text "      {\"${file}\", R\"~~embedded~~(${content})~~embedded~~\"},\n")
endforeach()
string(APPEND text "  };\n  return texts;\n}\n\n}  // namespace tubetwin\n")
file(WRITE "${OUTPUT}" "${text}")
