"""Makes `doubles` and `ledger`, beside this file, importable from the tests in all folders."""
