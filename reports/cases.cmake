# Turns every case folder (verification/*/case.toml, experiments/*/case.toml) into CTest tests; there is no list to edit
#
#   <case>.quick      label quick      at most 20 CPU seconds
#   <case>.must_fail  label quick      the broken twins
#   <case>.full       label full       minutes
#   <case>.campaign   label campaign   hours; only for cases whose sweep has campaign values, or with a check that names this tier
#
# All carry the case's areas as further labels. Choose with the label:  ctest -L quick,  ctest -L full.
# A plain `ctest` runs quick and full (under two hours); campaign tests need to be asked for:
#   ctest -C campaign -L campaign
#
# Needs the targets plumb and plumb_planted, and PLUMB_PYTHON (a Python 3.11 with the packages of reports/README.md).

# Adds the tests of all cases.
function(plumb_add_cases)
    if(NOT PLUMB_PYTHON)
        message(FATAL_ERROR "plumb_add_cases: PLUMB_PYTHON is not set; it names the Python that runs the judge")
    endif()
    file(GLOB case_files CONFIGURE_DEPENDS
        "${PROJECT_SOURCE_DIR}/verification/*/case.toml" "${PROJECT_SOURCE_DIR}/experiments/*/case.toml")
    foreach(case_file IN LISTS case_files)
        # The labels stand in the file, so a change of it has to configure again.
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${case_file}")
        get_filename_component(folder "${case_file}" DIRECTORY)
        plumb_add_case("${folder}" "${case_file}")
    endforeach()
endfunction()

# Sets `areas` to the names in the line  area = "..."  or  area = ["...", "..."]  of a case file.
function(plumb_case_areas case_file areas)
    file(STRINGS "${case_file}" area_line REGEX "^area[ \t]*=" LIMIT_COUNT 1)
    string(REGEX REPLACE "#.*$" "" area_line "${area_line}")
    string(REGEX MATCHALL "[\"'][^\"']+[\"']" quoted "${area_line}")
    string(REGEX REPLACE "[\"']" "" names "${quoted}")
    if(NOT names)
        message(FATAL_ERROR "${case_file}: the line  area = \"...\"  is missing")
    endif()
    set(${areas} "${names}" PARENT_SCOPE)
endfunction()

# Adds the tests of one case.
function(plumb_add_case folder case_file)
    get_filename_component(case "${folder}" NAME)
    plumb_case_areas("${case_file}" areas)
    plumb_add_judgement("${case}" "${folder}" quick "quick;${areas}" 300)
    plumb_add_judgement("${case}" "${folder}" must_fail "quick;${areas}" 300)
    plumb_add_judgement("${case}" "${folder}" full "full;${areas}" 7200)
    file(STRINGS "${case_file}" campaign_line REGEX "^[^#\"]*campaign[ \t]*=|^tiers[ \t]*=.*\"campaign\"" LIMIT_COUNT 1)
    if(campaign_line)
        plumb_add_judgement("${case}" "${folder}" campaign "campaign;${areas}" 172800 CONFIGURATIONS campaign)
    endif()
endfunction()

# Adds one test: the judge on one case and tier. `timeout` in seconds ends a run that hangs; it is no speed test.
function(plumb_add_judgement case folder tier labels timeout)
    add_test(NAME "${case}.${tier}" ${ARGN}
        COMMAND "${PLUMB_PYTHON}" -m plumb_reports judge "${folder}" --tier ${tier}
            --plumb "$<TARGET_FILE:plumb>" --planted "$<TARGET_FILE:plumb_planted>" --build "${PROJECT_BINARY_DIR}")
    set_tests_properties("${case}.${tier}" PROPERTIES
        LABELS "${labels}" TIMEOUT ${timeout} ENVIRONMENT "PYTHONPATH=${PROJECT_SOURCE_DIR}/reports")
endfunction()
