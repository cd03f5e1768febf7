"""What the generated libraries cost, side by side in one run with the usual other ways to do the same."""
