;;; tltl-mode.el --- Specifications of game play in TLTL  -*- lexical-binding: t -*-

;; Version: 0.1.0
;; Package-Requires: ((emacs "28.1"))
;; SPDX-License-Identifier: MIT

;;; Commentary:

;; Colours and comments of .tltl files.  For everything else, `eglot' starts `tltlc lsp'.

;;; Code:

(defconst tltl-mode--declarations
  '("import" "signal" "entity" "param" "clock" "predicate" "let" "exclusive" "spec" "test"))

(defconst tltl-mode--clauses
  '("reach" "keep" "avoid" "require" "level" "limit" "judge" "semantics" "tag" "all" "any" "when" "otherwise"))

(defconst tltl-mode--operators
  '("not" "and" "or" "implies" "iff" "then" "eventually" "always" "next" "weak_next" "until" "weak_until" "release"
    "strong_release" "once" "historically" "previously" "begins" "ends" "F" "G" "X" "N" "U" "W" "R" "M"))

(defconst tltl-mode--colours
  `((,(regexp-opt (append tltl-mode--declarations tltl-mode--clauses) 'symbols) . font-lock-keyword-face)
    (,(regexp-opt tltl-mode--operators 'symbols) . font-lock-builtin-face)
    (,(regexp-opt '("true" "false" "inf") 'symbols) . font-lock-constant-face)
    ;; Words that may also be names: they have a colour only at the start of a line.
    ("[[:word:])] +\\(is\\) +[A-Za-z_]" 1 font-lock-builtin-face)
    ("^\\s-*\\(step\\|expect\\)\\_>" 1 font-lock-keyword-face)
    ("\\_<clock\\s-+\\(varies\\)\\_>" 1 font-lock-keyword-face)
    ("[[:alnum:]_)%]\\s-+\\(since\\)\\s-+[[:alnum:]_(!]" 1 font-lock-builtin-face)
    ("\\_<\\(?:spec\\|predicate\\|let\\)\\s-+\\([A-Za-z_][A-Za-z0-9_.]*\\)" 1 font-lock-function-name-face)
    ("\\_<\\(?:signal\\|param\\)\\s-+\\([A-Za-z_][A-Za-z0-9_.]*\\)" 1 font-lock-variable-name-face)
    ("\\(?:\\_<expect\\|\\_<judge\\s-+at\\|\\_<semantics\\)\\s-+\\([a-z]+\\)" 1 font-lock-constant-face)))

;;;###autoload
(define-derived-mode tltl-mode prog-mode "TLTL"
  "Specifications of game play in truncated linear temporal logic."
  (modify-syntax-entry ?/ ". 12")
  (modify-syntax-entry ?\n ">")
  (modify-syntax-entry ?_ "_")
  (setq-local comment-start "// "
              comment-end ""
              indent-tabs-mode nil
              tab-width 4
              font-lock-defaults '(tltl-mode--colours)))

;;;###autoload
(add-to-list 'auto-mode-alist '("\\.tltl\\'" . tltl-mode))

(defvar eglot-server-programs)
(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs '(tltl-mode "tltlc" "lsp")))

(provide 'tltl-mode)
;;; tltl-mode.el ends here
