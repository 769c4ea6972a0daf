// The headers that most tests include; see tact_test_headers.
