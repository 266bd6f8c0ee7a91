"""What running nodes say of themselves, for browsers and for Prometheus: `garrison-web`."""
