;;; -*- lexical-binding: t -*-
;; Opens a program as a user does, and prints what Flymake shows:
;;
;;   emacs --batch -Q -l emacs.el -- TYPHON.EL SWIPL LIBRARY FILE

(setq load-prefer-newer t)
(pop command-line-args-left)            ; the two hyphens
(let ((mode (pop command-line-args-left)))
  (setq byte-compile-error-on-warn t
        byte-compile-dest-file-function
        (lambda (_) (make-temp-file "typhon" nil ".elc")))
  (unless (byte-compile-file mode)
    (kill-emacs 2))
  (load mode nil t))
(setq typhon-swipl (pop command-line-args-left)
      typhon-library (pop command-line-args-left))
(require 'prolog)
(add-hook 'prolog-mode-hook #'typhon-maybe-mode)
(find-file (pop command-line-args-left))
(prolog-mode)
(unless typhon-mode
  (kill-emacs 3))
(let ((answer 'none)
      (tries 0))
  (typhon-flymake (lambda (found) (setq answer found)))
  (while (and (eq answer 'none) (< tries 600))
    (setq tries (1+ tries))
    (accept-process-output nil 0.1))
  (dolist (found answer)
    (princ (format "%s %s %s\n"
                   (line-number-at-pos (flymake-diagnostic-beg found))
                   (flymake-diagnostic-type found)
                   (flymake-diagnostic-text found)))))
(goto-char (point-min))
(search-forward "move")
(font-lock-ensure)
(princ (format "move is %s\n" (get-text-property (1- (point)) 'face)))
