# cmake -DSOURCE=DIR -DPROJECT_VERSION=V -DBUILD_VERSION=V -DOUTPUT=FILE -P version.cmake
# Writes the header that version.cpp includes. Runs at every build; the file changes only with the version.
cmake_minimum_required(VERSION 3.25)
set(version "${BUILD_VERSION}")
if(NOT version)
    set(version "${PROJECT_VERSION}")
    find_program(GIT git)
    if(GIT AND EXISTS "${SOURCE}/.git")
        execute_process(COMMAND "${GIT}" -C "${SOURCE}" rev-list --count HEAD
            OUTPUT_VARIABLE count OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
        # Ignores tags, which would hide the commit: always the commit, with a mark for uncommitted changes.
        execute_process(COMMAND "${GIT}" -C "${SOURCE}" describe --always --abbrev=7 --exclude=* --dirty=.dirty
            OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
        if(count AND commit)
            set(version "${PROJECT_VERSION}+${count}.g${commit}")
        endif()
    endif()
endif()
if(NOT version MATCHES "^[A-Za-z0-9.+~-]+$")
    message(FATAL_ERROR "version '${version}': only letters, digits and . + ~ - are allowed")
endif()
file(CONFIGURE OUTPUT "${OUTPUT}" CONTENT "namespace tact {\nstatic constexpr char kVersionText[] = \"${version}\";\n}\n")
