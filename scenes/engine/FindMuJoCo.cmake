# MuJoCo 4.0.1 from the unpacked `mujoco-core` wheel: MUJOCO_ROOT is the folder that holds
# libmujoco.so.4.0.1 and include/. `./dev` puts it into build/deps/mujoco.
set(MUJOCO_VERSION 4.0.1)
set(MUJOCO_ROOT "${CMAKE_SOURCE_DIR}/build/deps/mujoco" CACHE PATH "Folder of the unpacked mujoco-core ${MUJOCO_VERSION}")
if(NOT EXISTS "${MUJOCO_ROOT}/include/mujoco/mujoco.h")
  message(FATAL_ERROR "MuJoCo is not in ${MUJOCO_ROOT}: run ./dev build, or give -DMUJOCO_ROOT= the folder of the unpacked mujoco-core ${MUJOCO_VERSION} wheel.")
endif()
file(STRINGS "${MUJOCO_ROOT}/include/mujoco/mujoco.h" _mujoco_version_line REGEX "#define mjVERSION_HEADER")
if(NOT _mujoco_version_line MATCHES "4000001")
  message(FATAL_ERROR "MuJoCo in ${MUJOCO_ROOT} is not ${MUJOCO_VERSION} (${_mujoco_version_line}); tubetwin's physics is pinned to ${MUJOCO_VERSION}, and 4.0.0 solves sparse systems wrongly.")
endif()
if(NOT TARGET MuJoCo::MuJoCo)
  add_library(MuJoCo::MuJoCo SHARED IMPORTED)
  set_target_properties(MuJoCo::MuJoCo PROPERTIES
    IMPORTED_LOCATION "${MUJOCO_ROOT}/libmujoco.so.${MUJOCO_VERSION}"
    INTERFACE_INCLUDE_DIRECTORIES "${MUJOCO_ROOT}/include")
endif()
