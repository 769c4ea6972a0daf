// The headers that most tests begin with; see tact_test_headers.
