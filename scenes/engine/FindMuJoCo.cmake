# MuJoCo 4.0.1 from the unpacked `mujoco-core` wheel: MUJOCO_ROOT is the folder that holds
# libmujoco.so.4.0.1 and include/. `./dev` puts it into build/deps/mujoco. Every measured figure of
# this project was made with this very library, so another version or build is refused.
set(MUJOCO_VERSION 4.0.1)
set(MUJOCO_VERSION_HEADER 4000001)
set(MUJOCO_LIBRARY_SHA256 0863b0c75c57512842e23f5ff6fd2d5f08b6451f17988edaaf7530a3a6e7cad1)
set(MUJOCO_ROOT "${CMAKE_SOURCE_DIR}/build/deps/mujoco" CACHE PATH
  "Folder of the unpacked mujoco-core ${MUJOCO_VERSION} wheel")

set(_mujoco_header "${MUJOCO_ROOT}/include/mujoco/mujoco.h")
set(_mujoco_library "${MUJOCO_ROOT}/libmujoco.so.${MUJOCO_VERSION}")
if(NOT EXISTS "${_mujoco_header}")
  message(FATAL_ERROR "MuJoCo is not in ${MUJOCO_ROOT}: run ./dev build, or give -DMUJOCO_ROOT= the folder of the unpacked mujoco-core ${MUJOCO_VERSION} wheel.")
endif()
file(STRINGS "${_mujoco_header}" _mujoco_line REGEX "#define mjVERSION_HEADER")
string(REGEX REPLACE "[^0-9]" "" _mujoco_found "${_mujoco_line}")
if(NOT _mujoco_found STREQUAL MUJOCO_VERSION_HEADER)
  message(FATAL_ERROR "MuJoCo in ${MUJOCO_ROOT} has version number ${_mujoco_found}, ${MUJOCO_VERSION_HEADER} (${MUJOCO_VERSION}) is needed: tubetwin's physics is pinned to it, and 4.0.0 solves sparse systems wrongly.")
endif()
if(NOT EXISTS "${_mujoco_library}")
  message(FATAL_ERROR "MuJoCo's library ${_mujoco_library} is missing beside its headers.")
endif()
file(SHA256 "${_mujoco_library}" _mujoco_sha256)
if(NOT _mujoco_sha256 STREQUAL MUJOCO_LIBRARY_SHA256)
  message(FATAL_ERROR "MuJoCo's library ${_mujoco_library} has sha256 ${_mujoco_sha256}, ${MUJOCO_LIBRARY_SHA256} (of the mujoco-core ${MUJOCO_VERSION} wheel) is needed: another build gives other results.")
endif()
if(NOT TARGET MuJoCo::MuJoCo)
  add_library(MuJoCo::MuJoCo SHARED IMPORTED)
  set_target_properties(MuJoCo::MuJoCo PROPERTIES
    IMPORTED_LOCATION "${_mujoco_library}"
    INTERFACE_INCLUDE_DIRECTORIES "${MUJOCO_ROOT}/include")
endif()
