# An overlay port: `vcpkg install pc --overlay-ports=packaging/vcpkg`, with cargo, cmake and libclang on the machine.
get_filename_component(sources "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
find_program(CARGO cargo PATHS "$ENV{HOME}/.cargo/bin" REQUIRED)

# A C library of another compiler: the same for programs that are debugged.
set(VCPKG_BUILD_TYPE release)
vcpkg_execute_required_process(
    COMMAND "${CARGO}" run --locked --package xtask -- install --prefix "${CURRENT_PACKAGES_DIR}"
    WORKING_DIRECTORY "${sources}"
    LOGNAME "install-${TARGET_TRIPLET}"
)

# pcConfig.cmake knows its own place, beside the libraries; it has the target pc::static as well as pc::pc.
set(VCPKG_POLICY_SKIP_MISPLACED_CMAKE_FILES_CHECK enabled)
set(VCPKG_POLICY_SKIP_LIB_CMAKE_MERGE_CHECK enabled)
set(VCPKG_POLICY_DLLS_IN_STATIC_LIBRARY enabled)
vcpkg_install_copyright(FILE_LIST "${sources}/LICENSE-MIT" "${sources}/LICENSE-APACHE")
