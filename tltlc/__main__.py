"""``python -m tltlc``."""

try:
    from tltlc.interfaces.cli.main import main

    main()
except KeyboardInterrupt:
    # Ctrl-C came before `main` could handle it.
    raise SystemExit(130) from None
