:- module(typhon_key_directories, []).

/** <module> Keys: what hosts and authors sign, seal and prove with

The options tls, identity and trail stand on this.  This is the interface of
the layer.
*/

:- reexport(keys/key_files, [key_loaded/3, keys_file/3]).
:- reexport(keys/keys,
            [ own_keys/1, own_keys_begin/1, own_keys_end/0, keys_sign/3,
              keys_verify/4, keys_seal/4, keys_unseal/3, keys_certificate/2,
              keys_holder/3 ]).
