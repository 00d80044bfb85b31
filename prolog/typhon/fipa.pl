:- module(typhon_fipa, []).

/** <module> A bridge to agents of FIPA's platforms, as those of JADE

    :- use_module(library(typhon/fipa)).

The whole interface is fipa_start/3, fipa_stop/1 and fipa_property/2; what
agents send and receive is described in [bridges-fipa.md].  Only the first two
are part of library(typhon).  It needs nothing but Prolog.  Nothing is defined
here: see the modules in bridges/fipa/.

  | starting and stopping           | common/starting           |
  | hosts as platforms              | service, platform         |
  | messages in and out, failures   | exchange                  |
  | HTTP: in, out, and its text     | reception, carriage, http |
  | messages and envelopes as bytes | letter                    |
  | messages, contents, their text  | acl, sl, sexp             |
  | AMS and DF                      | managers                  |
*/

:- use_module(tools/user_errors, [user_errors/1]).
:- reexport(bridges/common/starting, [fipa_start/3, fipa_stop/1]).
:- reexport(bridges/fipa/service).

:- user_errors(typhon_fipa).
