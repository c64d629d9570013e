# cmake -DOUT=FILE.cc -DNAMES=a;b -DFILES=x;y -P embed.cmake: texts as constants of the program.
set(source "// Made when building, from the files named in CMakeLists.txt.\n\
#include \"twin/report/assets.h\"\n\nnamespace tubetwin::report_assets {\n\n")
foreach(name file IN ZIP_LISTS NAMES FILES)
  file(READ ${file} text)
  if(text MATCHES "</script" OR text MATCHES "</style")
    message(FATAL_ERROR "${file} would end the element that it stands in")
  endif()
  string(APPEND source "const std::string_view ${name} = R\"tubetwin(${text})tubetwin\";\n")
endforeach()
string(APPEND source "\n}  // namespace tubetwin::report_assets\n")
file(WRITE ${OUT} "${source}")
